// The scenes of three axes as input decks of CalculiX. Its *ELASTIC with NLGEOM is Saint-Venant-Kirchhoff's law;
// what it calls neo-Hookean is another than those here, so that one law is compared.
#include <algorithm>

#include "scenes.hpp"

namespace brainshift::stability {
namespace {

// Of force and of displacement; ten times that leaves more than a millionth open (bench/peers).
constexpr const char* controls = "*CONTROLS,PARAMETERS=FIELD\n1.E-4,1.E-4\n";

// Numbers in twelve digits everywhere: what is longer than twenty characters CalculiX cannot read.
void print_nodes(const Mesh& mesh) {
  std::printf("*NODE,NSET=NALL\n");
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const auto x = mesh.nodes().row(i);
    std::printf("%d,%.12g,%.12g,%.12g\n", i + 1, x[0], x[1], x[2]);
  }
}

// Edges 12, 23, 13, 14, 24, 34 follow the corners: VTK's order, which is the library's.
void print_elements(const Mesh& mesh, Index region) {
  std::printf("*ELEMENT,TYPE=%s,ELSET=R%d\n", mesh.is_quadratic() ? "C3D10" : "C3D4", region);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (mesh.regions()[std::size_t(t)] != region) continue;
    std::printf("%d", t + 1);
    for (int k = 0; k < 4; ++k) std::printf(",%d", mesh.tets()(t, k) + 1);
    for (int k = 0; mesh.is_quadratic() && k < 6; ++k) std::printf(",%d", mesh.edge_nodes()(t, k) + 1);
    std::printf("\n");
  }
}

void print_fixed(const ConstraintSet& constraints) {
  std::printf("*BOUNDARY\n");
  for (const ConstraintGroup& group : constraints.groups()) {
    for (const Index node : group.nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        if (group.axes[std::size_t(axis)]) std::printf("%d,%d,%d\n", node + 1, axis + 1, axis + 1);
      }
    }
  }
}

void print_material(Index region, const Material& material) {
  std::printf("*MATERIAL,NAME=M%d\n*ELASTIC\n%.12g,%.12g\n", region, material.young(), material.poisson());
  if (material.density() > 0.0) std::printf("*DENSITY\n%.12g\n", material.density());
  std::printf("*SOLID SECTION,ELSET=R%d,MATERIAL=M%d\n", region, region);
}

struct Increments {
  bool automatic;   // cut where there is no balance, to a thousandth; results after each
  double first;     // part of the load
};

void print_step(const Scene& scene, const Increments& increments) {
  std::printf("*STEP,NLGEOM,INC=2000\n*STATIC%s\n%.12g,1.", increments.automatic ? "" : ",DIRECT",
              increments.first);
  if (increments.automatic) std::printf(",1.E-3,%.12g", increments.first);
  std::printf("\n%s", controls);
  const double size = scene.gravity.norm();
  const Vec3 direction = scene.gravity / size;
  for (const auto& [region, material] : scene.materials) {
    if (material.density() == 0.0) continue;
    std::printf("*DLOAD\nR%d,GRAV,%.12g,%.12g,%.12g,%.12g\n", region, size, direction.x(), direction.y(),
                direction.z());
  }
  std::printf("*NODE PRINT,NSET=NALL,FREQUENCY=%d\nU\n*END STEP\n", increments.automatic ? 1 : 100000);
}

// name: AXIS/ELEMENT/what else tells the case.
void print_deck(const std::string& name, const Scene& scene, const Increments& increments) {
  std::printf("** deck %s\n", name.c_str());
  print_nodes(scene.mesh);
  for (const auto& [region, material] : scene.materials) print_elements(scene.mesh, region);
  print_fixed(scene.constraints);
  for (const auto& [region, material] : scene.materials) print_material(region, material);
  print_step(scene, increments);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

constexpr Law law = Law::st_venant_kirchhoff;
constexpr Element compared[] = {Element::linear, Element::quadratic};   // C3D4 and C3D10

}  // namespace

void calculix_decks() {
  for (const Element element : compared) {
    const std::string kind = to_string(element);
    for (const Bar& bar : bars) {
      Scene scene = with(pressed_bar(bar, law), element);
      scene.gravity = {0, 0, -0.8 * standard_gravity};   // beyond the limit of the law, 0.73 where nu is 0.45
      print_deck("compression/" + kind + "/" + bar.name, scene, {true, 0.02});
    }
    for (const double below : below_half)
      print_deck("poisson/" + kind + "/" + number(below), with(leaning_cube(law, 0.5 - below, 3), element),
                 {false, 1.0});
    for (const double load : loads_across) {
      Scene scene = with(bent_bar(law), element);
      scene.gravity = {load * standard_gravity, 0, 0};
      for (const int calls : call_counts)
        print_deck("load_steps/" + kind + "/" + number(load) + "/" + std::to_string(calls), scene,
                   {false, 1.0 / calls});
    }
  }
}

}  // namespace brainshift::stability
