#include "coupling/track.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/LU>

#include "brainshift/error.hpp"
#include "mesh/edge_nodes.hpp"
#include "mesh/quadratic_tet.hpp"
#include "text.hpp"

namespace brainshift {
namespace {

// Barycentric weights along the line are linear: weights(s) = at_tip + s * slope.
struct Crossing {
  double from, to;   // mm from the tip; empty if from >= to
  Eigen::Vector4d at_tip, slope;
};

Crossing cross_tet(const Mesh& mesh, const Points& x, Index t, const Vec3& tip,
                   const Vec3& outward, double length) {
  Eigen::Matrix4d corners;   // columns: (position, 1)
  for (int a = 0; a < 4; ++a) {
    corners.col(a) << x.row(mesh.tets()(t, a)).transpose(), 1.0;
  }
  const Eigen::Matrix4d inverse = corners.inverse();
  Crossing c{0.0, length, inverse * Eigen::Vector4d(tip.x(), tip.y(), tip.z(), 1.0),
             inverse * Eigen::Vector4d(outward.x(), outward.y(), outward.z(), 0.0)};
  for (int a = 0; a < 4; ++a) {
    if (c.slope[a] == 0.0) {
      if (c.at_tip[a] < 0.0) c.to = -1.0;
      continue;
    }
    const double s = -c.at_tip[a] / c.slope[a];
    if (c.slope[a] > 0.0) {
      c.from = std::max(c.from, s);
    } else {
      c.to = std::min(c.to, s);
    }
  }
  return c;
}

// Whether the line can meet the tet at all: distance of its centre against its size.
bool may_cross(const Mesh& mesh, const Points& x, Index t, const Vec3& tip, const Vec3& outward) {
  Vec3 centre = Vec3::Zero();
  for (int a = 0; a < 4; ++a) centre += 0.25 * x.row(mesh.tets()(t, a)).transpose();
  double reach = 0.0;
  for (int a = 0; a < 4; ++a) {
    reach = std::max(reach, (x.row(mesh.tets()(t, a)).transpose() - centre).squaredNorm());
  }
  const Vec3 off = centre - tip;
  return (off - off.dot(outward) * outward).squaredNorm() <= reach;
}

// Points whose ties would say nothing that those of the others do not say already: where the line
// passes through all three tets around an edge, their five nodes hold four points, and on a curved
// device four such ties contradict each other.
class Independent {
 public:
  // Whether the point is independent of those taken before; then it is taken too.
  bool take(const Mesh& mesh, const PathPoint& point) {
    std::map<Index, double> rest;   // by node
    const Interpolation at = mesh.interpolation(point.tet, point.weights);
    for (std::size_t a = 0; a < std::size_t(at.count); ++a) {
      if (at.weights[a] != 0.0) rest[at.nodes[a]] = at.weights[a];
    }
    const double whole = norm(rest);
    for (int pass = 0; pass < 2; ++pass) {   // twice is enough (Kahan)
      for (const auto& unit : m_basis) {
        double part = 0.0;
        for (const auto& [node, value] : unit) {
          const auto found = rest.find(node);
          if (found != rest.end()) part += value * found->second;
        }
        if (part == 0.0) continue;
        for (const auto& [node, value] : unit) rest[node] -= part * value;
      }
    }
    const double left = norm(rest);
    if (left < least * whole) return false;
    for (auto& entry : rest) entry.second /= left;
    m_basis.push_back(std::move(rest));
    return true;
  }

 private:
  static constexpr double least = 1e-6;  // dependence is exact, or far from it
  static double norm(const std::map<Index, double>& v) {
    double sum = 0.0;
    for (const auto& entry : v) sum += entry.second * entry.second;
    return std::sqrt(sum);
  }
  std::vector<std::map<Index, double>> m_basis;
};

// Of a quadratic tet whose edges have bent: moves the point within the face it lies on, where the
// chords between the corners cross the line, to where the face itself does. False where that is not
// to be found close by.
bool onto_line(const Mesh& mesh, const Points& positions, const Vec3& tip, const Vec3& outward,
               PathPoint& point) {
  int corner[4], free = 0;   // of the face: the corners but that opposite, whose weight is least
  Eigen::Index opposite;
  point.weights.minCoeff(&opposite);
  for (int a = 0; a < 4; ++a) {
    if (a != opposite) corner[free++] = a;
  }
  point.weights[opposite] = 0.0;
  point.weights /= point.weights.sum();
  const auto nodes = ten_rows(positions, mesh.tets(), mesh.edge_nodes(), point.tet);
  const double close = 1e-13 * mesh.diameter();
  for (int i = 0; i < 20; ++i) {
    const Vec3 off = tip + point.arc * outward - nodes.transpose() * quadratic_shape(point.weights);
    if (off.norm() <= close) return point.weights.minCoeff() > -0.1;
    const Eigen::Matrix<double, 3, 4> slopes =
        nodes.transpose() * quadratic_shape_slopes(point.weights);
    Mat3 J;
    J << slopes.col(corner[1]) - slopes.col(corner[0]), slopes.col(corner[2]) - slopes.col(corner[0]),
        -outward;
    if (J.determinant() == 0.0) return false;
    const Vec3 step = J.inverse() * off;
    point.weights[corner[1]] += step[0];
    point.weights[corner[2]] += step[1];
    point.weights[corner[0]] -= step[0] + step[1];
    point.arc += step[2];
  }
  return false;
}

// Crossings with faces, none nearer than least_spacing to the one before; may be none at all.
std::vector<PathPoint> crossings(const Mesh& mesh, const Points& positions, const Vec3& tip,
                                 const Vec3& outward, double length, double least_spacing,
                                 Independent known) {
  struct Piece {
    Index tet;
    Crossing crossing;
  };
  std::vector<Piece> pieces;
  const double tiny = 1e-9 * mesh.diameter();
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (!may_cross(mesh, positions, t, tip, outward)) continue;
    const Crossing c = cross_tet(mesh, positions, t, tip, outward, length);
    if (c.to - c.from > tiny) pieces.push_back({t, c});
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return a.crossing.from != b.crossing.from ? a.crossing.from < b.crossing.from : a.tet < b.tet;
  });
  if (pieces.empty() || pieces.front().crossing.from > tiny) {
    throw Error(ErrorCode::invalid_argument,
                "the tip (" + text(tip.x()) + " " + text(tip.y()) + " " +
                    text(tip.z()) + ") of the device is not in tissue");
  }
  std::vector<PathPoint> path;
  double reached = 0.0;
  for (const Piece& piece : pieces) {
    const Crossing& c = piece.crossing;
    if (c.from > reached + 1e-6 * mesh.diameter()) {
      throw Error(ErrorCode::invalid_argument,
                  "the track leaves the tissue " + text(reached, 6) +
                      " mm from the tip and enters it again at " + text(c.from, 6) + " mm");
    }
    reached = std::max(reached, c.to);
    const double before = path.empty() ? 0.0 : path.back().arc;
    if (c.to - before < least_spacing || c.to >= length) continue;
    Eigen::Vector4d weights = (c.at_tip + c.to * c.slope).cwiseMax(0.0);
    weights /= weights.sum();
    PathPoint point{piece.tet, weights, c.to, 0.0, 0.0, {}, 0.0};
    if (mesh.is_quadratic() && !onto_line(mesh, positions, tip, outward, point)) continue;
    if (known.take(mesh, point)) path.push_back(point);
  }
  std::sort(path.begin(), path.end(),   // bent faces may change places
            [](const PathPoint& a, const PathPoint& b) { return a.arc < b.arc; });
  // Each point stands for the track half-way to its neighbours.
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double low = i == 0 ? 0.0 : 0.5 * (path[i - 1].arc + path[i].arc);
    const double high = i + 1 == path.size() ? reached : 0.5 * (path[i].arc + path[i + 1].arc);
    path[i].length = high - low;
  }
  return path;
}

}  // namespace

std::vector<PathPoint> cut_track(const Mesh& mesh, const Points& positions, const Vec3& tip,
                                 const Vec3& outward, double length, double least_spacing) {
  std::vector<PathPoint> path = crossings(mesh, positions, tip, outward, length, least_spacing, {});
  if (path.empty()) {
    throw Error(ErrorCode::invalid_argument, "the track crosses no face of the mesh");
  }
  return path;
}

std::vector<PathPoint> extend_track(const Mesh& mesh, const Points& positions, const Vec3& tip,
                                    const Vec3& outward, double advance, double least_spacing,
                                    const std::vector<PathPoint>& path) {
  Independent known;
  for (const PathPoint& point : path) known.take(mesh, point);
  std::vector<PathPoint> longer =
      crossings(mesh, positions, tip, outward, advance, least_spacing, std::move(known));
  for (PathPoint point : path) {
    point.arc += advance;
    longer.push_back(point);
  }
  return longer;
}

}  // namespace brainshift
