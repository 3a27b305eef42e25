// The head the procedure is done on: meshes, node sets and landmarks read from a folder.
#pragma once

#include <map>
#include <string>

#include "brainshift/brainshift.hpp"
#include "materials.hpp"

namespace dbs {

using namespace brainshift;

enum Side { left = 0, right = 1 };
inline const char* name_of(int side) { return side == left ? "left" : "right"; }

// A planned electrode: target, and the unit vector from it to the burr hole.
struct Plan {
  Vec3 target, outward;
};

struct Head {
  std::string name;
  Mesh brain;                       // region 1: left, 2: right
  Indices pair;                     // per node: its twin across the mid-surface, or -1
  Indices bridge, falx, stem, optic;   // node sets
  Points wall_points;               // inner skull, tentorium, and the mid-sheet between the sides
  Triangles wall[2];                // closed outward compartments, by Side
  Triangles skull;                  // outward, without the mid-sheet
  Triangles midsheet;               // normals to the right
  Points falx_points;
  Triangles falx_triangles;         // normals to the right
  std::map<std::string, Vec3> landmarks;   // mm, RAS
  std::map<int, Plan> plans;        // by Side; may be empty
  Indices labels = {};              // per tet: of the label map it was made from; empty: of none
  std::vector<Part> parts = {};     // with materials of their own, by those labels

  static int region(int side) { return side == left ? 1 : 2; }
};

// Reads brain.vtu, cavity.vtp, falx.vtp, head.json and, if there, materials.json; throws brainshift::Error naming the file
// and what is wrong with it.
// `scale`: of its lengths, about AC; `gap`: mm by which the inner skull is moved outwards.
Head read_head(const std::string& folder, double scale = 1.0, double gap = 0.0);

}  // namespace dbs
