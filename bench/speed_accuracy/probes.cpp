#include "probes.hpp"

namespace bench {
namespace {

using namespace dbs;

// `point`, or the tissue closest to it where it lies outside.
Vec3 in_tissue(const Head& head, const Vec3& point) {
  if (head.brain.locate(point.transpose()).tet.front() >= 0) return point;
  Eigen::Index nearest;
  (head.brain.nodes().rowwise() - point.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return head.brain.nodes().row(nearest);
}

void add_landmarks(const Head& head, const std::string& kind, const std::vector<std::string>& names,
                   std::vector<Probe>& probes) {
  for (const std::string& name : names) {
    probes.push_back({name, kind, in_tissue(head, head.landmarks.at(name))});
  }
}

// Along the planned line, from the target to where it leaves the brain.
void add_track(const Head& head, int side, std::vector<Probe>& probes) {
  constexpr double spacing = 10.0;   // mm
  const Plan& plan = head.plans.at(side);
  for (int i = 0;; ++i) {
    const Vec3 point = plan.target + i * spacing * plan.outward;
    if (head.brain.locate(point.transpose()).tet.front() < 0) return;
    probes.push_back({"track_" + std::string(name_of(side)) + "_" + std::to_string(int(i * spacing)),
                      "track", point});
  }
}

// The node of a side that lies farthest in a direction.
Vec3 farthest(const Head& head, int side, const Vec3& direction) {
  const Mesh& brain = head.brain;
  Index best = -1;
  double reach = 0.0;
  for (Index t = 0; t < brain.tet_count(); ++t) {
    if (brain.regions()[std::size_t(t)] != Head::region(side)) continue;
    for (int a = 0; a < 4; ++a) {
      const Index node = brain.tets()(t, a);
      const double along = brain.nodes().row(node).dot(direction);
      if (best >= 0 && along <= reach) continue;
      best = node;
      reach = along;
    }
  }
  return brain.nodes().row(best);
}

}  // namespace

std::vector<Probe> probes(const Head& head) {
  std::vector<Probe> all;
  add_landmarks(head, "STN", {"STN_left", "STN_right"}, all);
  for (int side : {left, right}) add_track(head, side, all);
  add_landmarks(head, "midline", {"AC", "MCP", "PC"}, all);
  add_landmarks(head, "cortex", {"entry_left", "entry_right", "frontal_pole_left", "frontal_pole_right"}, all);
  for (int side : {left, right}) {
    const std::string of = std::string("_") + name_of(side);
    const double outwards = side == right ? 1.0 : -1.0;
    all.push_back({"vertex" + of, "cortex", farthest(head, side, Vec3::UnitZ())});
    all.push_back({"occipital_pole" + of, "cortex", farthest(head, side, -Vec3::UnitY())});
    all.push_back({"side" + of, "cortex", farthest(head, side, outwards * Vec3::UnitX())});
  }
  return all;
}

Points points_of(const std::vector<Probe>& probes) {
  Points points(Eigen::Index(probes.size()), 3);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    points.row(Eigen::Index(i)) = probes[i].point.transpose();
  }
  return points;
}

}  // namespace bench
