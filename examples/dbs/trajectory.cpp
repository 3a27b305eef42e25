#include "trajectory.hpp"

#include <cmath>
#include <limits>

namespace dbs {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;
constexpr double never = std::numeric_limits<double>::infinity();

// Distance along the ray to the triangle, or infinity: solves start + s d = a + u (b-a) + v (c-a).
double distance_to(const Vec3& start, const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, normal = ab.cross(ac);
  const double across = d.dot(normal);
  if (std::abs(across) < 1e-12 * normal.norm()) return never;
  const double s = (a - start).dot(normal) / across;
  const Vec3 off = start + s * d - a;
  const double u = off.cross(ac).dot(normal) / normal.squaredNorm();
  const double v = ab.cross(off).dot(normal) / normal.squaredNorm();
  const double slack = -1e-9;   // an edge belongs to both of its triangles
  return s > 0.0 && u >= slack && v >= slack && u + v <= 1.0 - slack ? s : never;
}

double first_crossing(const Points& points, const Triangles& triangles, const Vec3& start,
                      const Vec3& direction) {
  double nearest = never;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    nearest = std::min(nearest, distance_to(start, direction, points.row(triangles(t, 0)),
                                            points.row(triangles(t, 1)),
                                            points.row(triangles(t, 2))));
  }
  return nearest;
}

[[noreturn]] void refuse(int side, const std::string& what) {
  throw Error(ErrorCode::invalid_argument, std::string("trajectory, ") + name_of(side) + ": " + what);
}

std::string text(const Vec3& v) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "(%.2f %.2f %.2f)", v.x(), v.y(), v.z());
  return buffer;
}

}  // namespace

Vec3 outward_of(int side, double sagittal, double lateral) {
  const double a = sagittal * degree, b = lateral * degree, sign = side == right ? 1.0 : -1.0;
  return {sign * std::sin(b), std::cos(b) * std::cos(a), std::cos(b) * std::sin(a)};
}

Trajectory make_trajectory(const Head& head, int side, const Vec3& target, const Vec3& outward) {
  if (!target.allFinite() || !outward.allFinite()) refuse(side, "a coordinate is not finite");
  const Index tet = head.brain.locate(target.transpose()).tet.front();
  if (tet < 0) refuse(side, "the target " + text(target) + " is not in tissue");
  if (head.brain.regions()[std::size_t(tet)] != Head::region(side)) {
    refuse(side, "the target " + text(target) + " lies in the other half of the brain");
  }
  const double skull = first_crossing(head.wall_points, head.skull, target, outward);
  const double middle = first_crossing(head.wall_points, head.midsheet, target, outward);
  if (middle < skull) {
    refuse(side, "it crosses the midline " + std::to_string(middle) + " mm from the target");
  }
  if (!std::isfinite(skull)) refuse(side, "it does not meet the skull");
  if (outward.z() <= 0.0) refuse(side, "it leads downwards from its target");
  return {target, outward, target + skull * outward, skull};
}

double contact_arc(const Options& o) {
  if (o.contact == 0) return 0.0;
  const DeviceData& lead = device_data(o.lead);
  if (o.contact > lead.contact_count) {
    throw Error(ErrorCode::invalid_argument,
                "--contact " + std::to_string(o.contact) + ": " + o.lead + " has " +
                    std::to_string(lead.contact_count));
  }
  return lead.tip + 0.5 * lead.contact_length +
         (o.contact - 1) * (lead.contact_length + lead.contact_gap);
}

Goal plan_goal(const Head& head, const Options& o, int side) {
  const auto planned = head.plans.find(side);
  Vec3 target = planned != head.plans.end() ? planned->second.target
                                            : head.landmarks.at(std::string("STN_") + name_of(side));
  Vec3 outward = planned != head.plans.end() ? planned->second.outward : outward_of(side, 60.0, 20.0);
  if (!o.target.empty()) {
    const auto landmark = head.landmarks.find(o.target + "_" + name_of(side));
    if (landmark == head.landmarks.end()) {
      refuse(side, "the head has no landmark '" + o.target + "_" + name_of(side) + "'");
    }
    target = landmark->second;
  }
  const std::vector<double>& given = side == right ? o.target_right : o.target_left;
  if (!given.empty()) target = Vec3(given[0], given[1], given[2]);
  const bool turned = !std::isnan(o.sagittal) || !std::isnan(o.lateral);
  if (turned) {
    outward = outward_of(side, std::isnan(o.sagittal) ? 60.0 : o.sagittal,
                         std::isnan(o.lateral) ? 20.0 : o.lateral);
  }
  return {target, outward};
}

Trajectory aim_at(const Head& head, const Options& o, int side, const Vec3& point,
                  const Vec3& outward) {
  const std::vector<double>& given = side == right ? o.offset_right : o.offset_left;
  const Vec3 offset = given.empty() ? Vec3::Zero() : Vec3(given[0], given[1], given[2]);
  return make_trajectory(head, side, point + offset - contact_arc(o) * outward, outward);
}

}  // namespace dbs
