// What a stepper answers: fields, points, errors, compartments, contacts.
#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

struct View {
  const double* values;
  Eigen::Index rows, columns;
};

template <class Matrix>
View view_of(const Matrix& m) {
  return {m.data(), m.rows(), m.cols()};
}

// Computes the field into its place in the handle; what the stepper itself holds has its place there.
View view_of_field(brs_stepper& s, int32_t field) {
  const Stepper& stepper = s.value;
  const auto vectors = [&](Points computed) {
    return view_of(s.vectors[std::size_t(field)] = std::move(computed));
  };
  const auto scalars = [&](Eigen::VectorXd computed) {
    return view_of(s.scalars[std::size_t(field)] = std::move(computed));
  };
  switch (field) {
    case BRS_FIELD_DISPLACEMENT: return view_of(stepper.displacement());
    case BRS_FIELD_POSITION: return vectors(stepper.positions());
    case BRS_FIELD_JACOBIAN: return scalars(stepper.jacobians());
    case BRS_FIELD_FLUID_PRESSURE: return scalars(stepper.fluid_pressure());
    case BRS_FIELD_INTERNAL_FORCE: return vectors(stepper.internal_force());
    case BRS_FIELD_GRAVITY_FORCE: return vectors(stepper.gravity_force());
    case BRS_FIELD_FLUID_FORCE: return vectors(stepper.fluid_force());
    case BRS_FIELD_EXTERNAL_FORCE: return vectors(stepper.external_force());
    case BRS_FIELD_VELOCITY: return view_of(stepper.velocity());
    case BRS_FIELD_ITERATE: return view_of(stepper.iterate());
    case BRS_FIELD_FARTHEST: return view_of(stepper.farthest().displacement);
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no field with the number " + std::to_string(field));
  }
}

// displacement_at and rest_points_of differ in the question only.
using Question = PointValues (Stepper::*)(const Points&) const;

brs_status at_points(brs_stepper* stepper, Question question, const double* points, int64_t count,
                     double* values, int32_t* tets) noexcept {
  return guard(stepper, [&](brs_stepper& s) -> brs_status {
    const auto asked = rows<Points>(points, count, "points");
    require_array(values, count, "values");
    const PointValues answer = (s.value.*question)(asked);
    if (count == 0) return BRS_OK;
    write_array(answer.values, values);
    if (tets) std::memcpy(tets, answer.tet.data(), answer.tet.size() * sizeof *tets);
    return remark_outside(*s.context, answer.tet);
  });
}

brs_compartment_state compartment_state_of(const CompartmentState& c) {
  return {sizeof(brs_compartment_state),
          c.head,
          c.fluid_volume,
          c.air_volume,
          c.tissue_volume,
          c.lost_volume,
          c.open ? 1 : 0};
}

brs_contact_state contact_state_of(const ContactState& c, const ConstraintGroup& group) {
  return {
      sizeof(brs_contact_state), c.gap.size(),   c.active,           c.gap.data(),
      c.multiplier.data(),       c.force.data(), group.nodes.data(), int64_t(group.partners.size()),
      group.partners.data()};
}

}  // namespace

brs_status brs_stepper_field(brs_stepper* stepper, int32_t field, const double** values,
                             int64_t* rows, int64_t* columns) {
  return guard(stepper, [&](brs_stepper& s) {
    auto& place = result(values, "values");
    const View view = view_of_field(s, field);
    place = view.values;
    if (rows) *rows = view.rows;
    if (columns) *columns = view.columns;
  });
}

brs_status brs_stepper_displacement_at(brs_stepper* stepper, const double* points, int64_t count,
                                       double* values, int32_t* tets) {
  return at_points(stepper, &Stepper::displacement_at, points, count, values, tets);
}

brs_status brs_stepper_rest_points_of(brs_stepper* stepper, const double* points, int64_t count,
                                      double* values, int32_t* tets) {
  return at_points(stepper, &Stepper::rest_points_of, points, count, values, tets);
}

brs_status brs_stepper_estimate_error(brs_stepper* stepper, const double* points, int64_t count,
                                      double* errors, double* corrections) {
  return guard(stepper, [&](brs_stepper& s) -> brs_status {
    const auto asked = rows<Points>(points, count, "points");
    require_array(errors, count, "errors");
    const ErrorEstimate found = s.value.estimate_error(asked);
    write_array(found.error, errors);
    if (corrections) write_array(found.correction, corrections);
    return remark_outside(*s.context, found.error.array().isNaN().count(), found.error.size());
  });
}

brs_status brs_compartment_state_init(brs_compartment_state* state, int64_t struct_size) {
  return init(state, struct_size, compartment_state_of(CompartmentState()));
}

brs_status brs_stepper_compartment(brs_stepper* stepper, int32_t compartment,
                                   brs_compartment_state* state) {
  return guard(stepper, [&](brs_stepper& s) {
    checked_size(state, "state");
    write(state, compartment_state_of(s.value.compartment(compartment)), "state");
  });
}

brs_status brs_contact_state_init(brs_contact_state* state, int64_t struct_size) {
  return init(state, struct_size, contact_state_of(ContactState(), ConstraintGroup()));
}

brs_status brs_stepper_contact(brs_stepper* stepper, int32_t id, brs_contact_state* state) {
  return guard(stepper, [&](brs_stepper& s) {
    checked_size(state, "state");
    ContactState found = s.value.contact(id);
    ContactState& kept = s.contacts[id];
    kept = std::move(found);
    write(state, contact_state_of(kept, s.value.constraints().group(id)), "state");
  });
}
