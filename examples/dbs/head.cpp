#include "head.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "brainshift/io.hpp"

namespace dbs {
namespace {

Indices to_indices(const io::Field& field) {
  Indices values(std::size_t(field.values.rows()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = Index(std::lround(field.values(Eigen::Index(i), 0)));
  }
  return values;
}

Indices marked(const io::Field& field) {
  Indices nodes;
  for (Eigen::Index i = 0; i < field.values.rows(); ++i) {
    if (field.values(i, 0) != 0.0) nodes.push_back(Index(i));
  }
  return nodes;
}

Indices labels_of(const io::Grid& brain) {   // the generic head has none
  for (const io::Field& field : brain.cell_fields) {
    if (field.name == "label") return to_indices(field);
  }
  return {};
}

Triangles pick(const Triangles& all, const Indices& parts, int part, bool turned) {
  Triangles some(all.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < all.rows(); ++i) {
    if (parts[std::size_t(i)] != part) continue;
    some.row(count) = all.row(i);
    if (turned) std::swap(some(count, 1), some(count, 2));
    ++count;
  }
  return some.topRows(count);
}

Triangles join(const Triangles& a, const Triangles& b) {
  Triangles both(a.rows() + b.rows(), 3);
  both << a, b;
  return both;
}

Vec3 read_vector(const nlohmann::json& value, const std::string& culprit) {
  if (!value.is_array() || value.size() != 3 || !value[0].is_number() || !value[1].is_number() ||
      !value[2].is_number()) {
    throw Error(ErrorCode::file, culprit + " is not three numbers");
  }
  return Vec3(value[0], value[1], value[2]);
}

struct Marks {   // what head.json holds
  std::string name;
  std::map<std::string, Vec3> landmarks;
  std::map<int, Plan> plans;
};

void read_plans(const nlohmann::json& json, const std::string& path, Marks& head) {
  if (!json.contains("trajectories")) return;
  for (int side : {left, right}) {
    const auto found = json["trajectories"].find(name_of(side));
    if (found == json["trajectories"].end()) continue;
    const std::string culprit = path + ": trajectory '" + name_of(side) + "': ";
    const Vec3 direction = read_vector(found->value("direction", nlohmann::json()),
                                       culprit + "direction");
    if (!(direction.norm() > 0.0)) throw Error(ErrorCode::file, culprit + "direction is zero");
    head.plans[side] = {read_vector(found->value("target", nlohmann::json()), culprit + "target"),
                        direction.normalized()};
  }
}

Marks read_marks(const std::string& path) {
  Marks head;
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::file, path + ": cannot be read");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (json.is_discarded() || !json.contains("landmarks")) {
    throw Error(ErrorCode::file, path + ": is not JSON with an object 'landmarks'");
  }
  if (json.value("frame", "") != "RAS" || json.value("units", "") != "mm") {
    throw Error(ErrorCode::file, path + ": frame and units must be \"RAS\" and \"mm\"");
  }
  head.name = json.value("name", "head");
  for (const auto& [name, value] : json["landmarks"].items()) {
    head.landmarks[name] = read_vector(value, path + ": landmark '" + name + "'");
  }
  for (const char* needed : {"AC", "PC", "STN_left", "STN_right", "frontal_pole_left",
                             "frontal_pole_right"}) {
    if (!head.landmarks.count(needed)) {
      throw Error(ErrorCode::file, path + ": landmark '" + needed + "' is missing");
    }
  }
  read_plans(json, path, head);
  return head;
}

// Lengths grow about a point; factor 1 leaves every bit.
void scale(const Vec3& centre, double factor, Points& points) {
  if (factor == 1.0) return;
  points = ((points.rowwise() - centre.transpose()) * factor).rowwise() + centre.transpose();
}

void scale(const Vec3& centre, double factor, Vec3& point) {
  if (factor != 1.0) point = centre + factor * (point - centre);
}

// Moves the points of the triangles along their normals (of the triangles around them, by area).
void inflate(const Triangles& triangles, double gap, Points& points) {
  Points normals = Points::Zero(points.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = points.row(triangles(t, 0)), b = points.row(triangles(t, 1)),
               c = points.row(triangles(t, 2));
    for (int k = 0; k < 3; ++k) normals.row(triangles(t, k)) += (b - a).cross(c - a).transpose();
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (normals.row(i).norm() > 0.0) points.row(i) += gap * normals.row(i).normalized();
  }
}

}  // namespace

Head read_head(const std::string& folder, double factor, double gap) {
  Marks marks = read_marks(folder + "/head.json");
  const Vec3 centre = marks.landmarks.at("AC");
  io::Grid brain = io::read_vtu(folder + "/brain.vtu");
  io::Grid cavity = io::read_vtp(folder + "/cavity.vtp");
  io::Grid sheet = io::read_vtp(folder + "/falx.vtp");
  for (io::Grid* grid : {&brain, &cavity, &sheet}) scale(centre, factor, grid->points);
  for (auto& [name, point] : marks.landmarks) scale(centre, factor, point);
  for (auto& [side, plan] : marks.plans) scale(centre, factor, plan.target);
  Head head{marks.name, Mesh(brain.points, brain.tets, to_indices(brain.cell_field("region"))),
            {}, {}, {}, {}, {}, cavity.points, {}, {}, {}, sheet.points, sheet.triangles,
            marks.landmarks, marks.plans};
  head.pair = to_indices(brain.node_field("pair"));
  head.bridge = marked(brain.node_field("bridge"));
  head.falx = marked(brain.node_field("falx"));
  head.stem = marked(brain.node_field("stem"));
  head.optic = marked(brain.node_field("optic"));
  head.labels = labels_of(brain);
  const std::string parts_of = folder + "/materials.json";
  if (std::filesystem::exists(parts_of)) head.parts = read_parts(parts_of);
  const Indices parts = to_indices(cavity.cell_field("part"));
  const Triangles walls[2] = {pick(cavity.triangles, parts, 1, false),
                              pick(cavity.triangles, parts, 2, false)};
  head.skull = join(walls[left], walls[right]);
  head.midsheet = pick(cavity.triangles, parts, 3, false);
  if (gap != 0.0) inflate(head.skull, gap, head.wall_points);
  head.wall[left] = join(walls[left], head.midsheet);
  head.wall[right] = join(walls[right], pick(cavity.triangles, parts, 3, true));
  return head;
}

}  // namespace dbs
