// The same ties k times: k leads on one track, each with a k-th of the stiffness and of the friction, so
// that the tissue must not notice.
#include "axes.hpp"
#include "support/leaning_block.hpp"

namespace brainshift::stability {
namespace {

using namespace brainshift::test;

struct Way {
  const char* name;
  double bending;      // mN mm^2, of all together
  double shear_bound;  // kPa, of all together
  bool rigid;
};
constexpr Way ways[] = {{"held by the wire", 5000.0, 0.0, false},
                        {"with friction", 5000.0, 0.01, false},
                        {"rigid and held", 5000.0, 0.0, true}};

Points row(Element element, const Way& way, int copies, const Points& one) {
  Stepper stepper(with(block_on_base(Vec3::Zero(), {3, 3, 4}), element));
  TrackOptions track;
  track.shear_bound = way.shear_bound / copies;
  for (int i = 0; i < copies; ++i)
    stepper.insert(lead(way.bending / copies), {lead_tip, lead_outward},
                   way.rigid ? whole() : wire_only(), track);
  stepper.set_gravity({0.02 * standard_gravity, 0, -0.02 * standard_gravity});
  const SolveReport r = stepper.solve_static();
  const double off = copies == 1 ? 0.0 : largest_distance(stepper.displacement(), one);
  std::printf("%s,%s,%d,%d,%d,%d,%d,%.2e,%.2e,%.2e,%s,%s\n", to_string(element), way.name, copies,
              r.coupling_rows, r.coupling_rank, int(r.coupling_unique), r.iterations, r.residual,
              r.tie_gap, off, to_string(r.status), quoted(r.message).c_str());
  return stepper.displacement();
}

}  // namespace

void devices_on_one_track() {
  std::printf(
      "element,way,copies,rows,rank,unique,iterations,residual,tie_gap,off_one_mm,status,"
      "message\n");
  for (const Element element : elements) {
    for (const Way& way : ways) {
      Points one;
      for (const int copies : {1, 2, 4, 8}) {
        const Points u = row(element, way, copies, one);
        if (copies == 1) one = u;
      }
    }
  }
}

}  // namespace brainshift::stability
