// Devices through the C face answer what they answer in C++, bit for bit.
#include <cstring>
#include <limits>

#include "brainshift/brainshift.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

constexpr double length = 25.0;  // mm
const Vec3 tip{15.0, 15.0, 8.0}, outward{0.0, 0.0, 1.0};

// The same device, in C and in C++.
class Devices : public testing::Test {
 protected:
  World w;
  brs_device_state state;
  brs_hold hold;
  brs_track_options track;
  brs_device* lead = nullptr;
  BeamDevice cpp_lead = make_device("3389", length);

  Devices() {
    brs_device_state_init(&state, sizeof state);
    brs_hold_init(&hold, sizeof hold);
    brs_track_options_init(&track, sizeof track);
    w.good(brs_device_create_named(w.context, "3389", length, nullptr, &lead));
  }
  ~Devices() override { brs_device_destroy(lead); }

  // A snapshot of the stepper behind the C face becomes a stepper in C++, by way of its recording.
  Stepper twin() const {
    std::int64_t count = 0;
    w.good(brs_stepper_record(w.stepper, nullptr, 0, &count));
    Bytes bytes(std::size_t(count), 0);
    w.good(brs_stepper_record(w.stepper, bytes.data(), count, &count));
    return Stepper::replay(bytes);
  }

  void expect_same(const Stepper& cpp, DeviceId id) {
    const DeviceState d = cpp.device(id);
    w.good(brs_stepper_device(w.stepper, id, &state));
    EXPECT_EQ(d.name, state.name);
    ASSERT_EQ(state.node_count, d.nodes.rows());
    ASSERT_EQ(state.path_count, d.path.rows());
    ASSERT_EQ(state.contact_count, d.contact_centres.rows());
    same(d.nodes, state.nodes);
    same(d.contact_centres, state.contact_centres);
    same(d.path, state.path);
    same(d.path_arcs, state.path_arcs);
    same(d.path_forces, state.path_forces);
    same(d.anchor_force, state.anchor_force);
    same(d.bow_direction, state.bow_direction);
    for (Index i = 0; i < state.node_count; ++i)
      same(d.frames[std::size_t(i)], state.frames + 9 * i);
    EXPECT_EQ(state.bow, d.bow);
    EXPECT_EQ(state.bow_arc, d.bow_arc);
    EXPECT_EQ(state.slide, d.slide);
    EXPECT_EQ(state.largest_tie_gap, d.largest_tie_gap);
    const Points& u = cpp.displacement();
    EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), std::vector<double>(u.data(), u.data() + u.size()));
  }

  template <class Matrix>
  static void same(const Matrix& expected, const double* found) {
    EXPECT_EQ(std::memcmp(expected.data(), found, std::size_t(expected.size()) * sizeof *found), 0);
  }

  brs_status insert(std::int32_t* id) {
    return brs_stepper_insert(w.stepper, lead, tip.data(), outward.data(), &hold, &track, id);
  }
};

TEST_F(Devices, InsertedMovedAndReleasedAreThoseOfTheCppLibrary) {
  Stepper cpp = twin();
  std::int32_t id = -1;
  hold.rigid_from = 0.0;
  track.shear_bound = 0.1;
  w.good(insert(&id));
  TrackOptions options;
  options.shear_bound = 0.1;
  ASSERT_EQ(cpp.insert(cpp_lead, {tip, outward}, {0.0}, options), id);
  for (double lost : {4000.0, 9000.0}) {
    w.good(w.solve_after_loss(lost));
    cpp.csf().set_lost_volume(0, lost);
    ASSERT_TRUE(cpp.solve_static().converged());
    expect_same(cpp, id);
  }
  brs_hold_init(&hold, sizeof hold);
  hold.anchor = length;
  hold.slack = 0.5;
  w.good(brs_stepper_set_hold(w.stepper, id, &hold));
  w.good(brs_stepper_set_friction(w.stepper, id, 0.05, 2.0));
  cpp.set_hold(id, {std::numeric_limits<double>::infinity(), length, false, 0.5});
  cpp.set_friction(id, 0.05, 2.0);
  brs_solve_report report;
  brs_solve_report_init(&report, sizeof report);
  w.good(brs_stepper_solve_static(w.stepper, &report));
  const SolveReport solved = cpp.solve_static();
  ASSERT_TRUE(solved.converged());
  expect_same(cpp, id);
  EXPECT_GT(state.bow, 0.0);
  EXPECT_EQ(report.coupling_rows, solved.coupling_rows);
  EXPECT_EQ(report.coupling_rank, solved.coupling_rank);
  EXPECT_EQ(report.coupling_unique, 1);
  EXPECT_EQ(report.tie_gap, solved.tie_gap);
  EXPECT_GT(report.coupling_rows, 0);

  w.good(brs_stepper_exchange(w.stepper, id, lead, &hold, 2.0));
  cpp.exchange(id, cpp_lead, {std::numeric_limits<double>::infinity(), length, false, 0.5}, 2.0);
  w.good(brs_stepper_solve_static(w.stepper, nullptr));
  ASSERT_TRUE(cpp.solve_static().converged());
  expect_same(cpp, id);
  w.good(brs_stepper_remove_device(w.stepper, id));
  EXPECT_EQ(brs_stepper_device(w.stepper, id, &state), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(w.message().find("device"), std::string::npos);
}

TEST_F(Devices, WithLocalGiveAreThoseOfTheCppLibrary) {
  Stepper cpp = twin();
  std::int32_t id = -1;
  hold.rigid_from = 0.0;
  track.local_give = 1;
  w.good(insert(&id));
  TrackOptions options;
  options.local_give = true;
  ASSERT_EQ(cpp.insert(cpp_lead, {tip, outward}, {0.0}, options), id);
  w.good(w.solve_after_loss(9000.0));
  cpp.csf().set_lost_volume(0, 9000.0);
  ASSERT_TRUE(cpp.solve_static().converged());
  expect_same(cpp, id);
  const std::vector<double> giving = w.field(BRS_FIELD_DISPLACEMENT);
  w.good(brs_stepper_restore(w.stepper, w.snapshot));
  track.local_give = 0;
  w.good(insert(&id));
  w.good(w.solve_after_loss(9000.0));
  EXPECT_NE(w.field(BRS_FIELD_DISPLACEMENT), giving);
}

TEST_F(Devices, OfAnOlderHeaderAreInsertedWithoutLocalGive) {
  brs_track_options_init(&track, 32);
  track.local_give = 1;   // beyond what that header knew
  std::int32_t id = -1;
  hold.rigid_from = 0.0;
  w.good(insert(&id));
  w.good(w.solve_after_loss(9000.0));
  const std::vector<double> old = w.field(BRS_FIELD_DISPLACEMENT);
  w.good(brs_stepper_restore(w.stepper, w.snapshot));
  brs_track_options_init(&track, sizeof track);
  EXPECT_EQ(track.local_give, 0);
  w.good(insert(&id));
  w.good(w.solve_after_loss(9000.0));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), old);
}

TEST_F(Devices, MadeFromArraysAreThoseOfTheTable) {
  brs_device_info info;
  brs_device_info_init(&info, sizeof info);
  w.good(brs_device_describe(lead, &info));
  EXPECT_STREQ(info.name, "3389");
  EXPECT_EQ(info.length, length);
  ASSERT_EQ(info.node_count, cpp_lead.node_count());
  same(cpp_lead.nodes(), info.nodes);
  same(cpp_lead.arcs(), info.arcs);
  ASSERT_EQ(info.contact_count, std::int64_t(cpp_lead.contacts().size()));
  for (std::size_t i = 0; i < cpp_lead.contacts().size(); ++i) {
    EXPECT_EQ(info.contacts[2 * i], cpp_lead.contacts()[i].from);
    EXPECT_EQ(info.contacts[2 * i + 1], cpp_lead.contacts()[i].to);
  }

  brs_device_entry entry;
  brs_device_entry_init(&entry, sizeof entry);
  std::int32_t index = 0;
  do w.good(brs_device_table(w.context, index++, &entry));
  while (std::string(entry.name) != "3389");
  EXPECT_EQ(entry.contact_count, info.contact_count);
  EXPECT_EQ(entry.bending, device_data("3389").bending);
  EXPECT_EQ(brs_device_table(w.context, 1000, &entry), BRS_ERROR_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(brs_device_table(w.context, -1, &entry), BRS_ERROR_INDEX_OUT_OF_RANGE);

  double section[BRS_SECTION_COLUMNS];
  w.good(brs_section_rod(w.context, entry.outer_diameter, entry.bending, 0.45, 0.0, section));
  const BeamSection rod = rod_section(entry.outer_diameter, entry.bending, 0.45);
  const double expected[] = {rod.axial,  rod.bending_2, rod.bending_3,   rod.torsion,
                             rod.radius, rod.shear,     rod.line_density};
  EXPECT_EQ(std::memcmp(section, expected, sizeof section), 0);
  EXPECT_EQ(brs_section_tube(w.context, 1.0, 2.0, 1.0, 0.3, 0.0, section),
            BRS_ERROR_INVALID_ARGUMENT);

  brs_device* made = nullptr;
  const double contacts[] = {1.5, 3.0};
  w.good(brs_device_create(w.context, "mine", info.nodes, info.node_count, section, 1, contacts, 1,
                           info.frames, info.node_count, &made));
  w.good(brs_device_describe(made, &info));
  same(cpp_lead.nodes(), info.nodes);
  same(cpp_lead.arcs(), info.arcs);
  ASSERT_EQ(info.contact_count, 1);
  EXPECT_EQ(info.contacts[0], 1.5);
  EXPECT_EQ(info.contacts[1], 3.0);
  brs_device_destroy(made);
}

TEST_F(Devices, RefusalsNameTheCulpritAndChangeNothing) {
  std::int32_t id = 77;
  EXPECT_EQ(insert(&id), BRS_ERROR_INVALID_ARGUMENT);  // nothing holds it
  EXPECT_NE(w.message().find("nothing holds"), std::string::npos) << w.message();
  hold.rigid_from = NAN;
  EXPECT_EQ(insert(&id), BRS_ERROR_INVALID_ARGUMENT);
  hold.rigid_from = 0.0;
  const double outside[] = {100.0, 0.0, 0.0};
  EXPECT_EQ(brs_stepper_insert(w.stepper, lead, outside, outward.data(), &hold, nullptr, &id),
            BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_insert(w.stepper, lead, tip.data(), outside, &hold, nullptr, &id),
            BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(brs_stepper_insert(w.stepper, lead, nullptr, outward.data(), &hold, nullptr, &id),
            BRS_ERROR_NULL);
  EXPECT_EQ(brs_stepper_insert(w.stepper, lead, tip.data(), outward.data(), nullptr, nullptr, &id),
            BRS_ERROR_NULL);
  EXPECT_EQ(insert(nullptr), BRS_ERROR_NULL);
  EXPECT_EQ(id, 77);
  EXPECT_EQ(brs_stepper_set_hold(w.stepper, 0, &hold), BRS_ERROR_INVALID_ARGUMENT);
  brs_device* none = lead;
  EXPECT_EQ(brs_device_create_named(w.context, "spoon", length, nullptr, &none),
            BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(none, nullptr);
  EXPECT_NE(w.message().find("spoon"), std::string::npos);
  w.good(insert(&id));
  EXPECT_EQ(id, 0);  // nothing of the above has taken a number
}

TEST_F(Devices, AModelOutlivesWhatItWasInsertedIn) {
  std::int32_t id = -1;
  hold.rigid_from = 0.0;
  w.good(insert(&id));
  brs_device* model = nullptr;
  w.good(brs_stepper_device_model(w.stepper, id, &model));
  brs_stepper_destroy(w.stepper);
  w.stepper = nullptr;
  brs_device_info info;
  brs_device_info_init(&info, sizeof info);
  w.good(brs_device_describe(model, &info));
  EXPECT_EQ(info.length, length);
  brs_device_destroy(model);
}

}  // namespace
}  // namespace brainshift::test
