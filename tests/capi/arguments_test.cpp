// Arguments that make no sense: a status, a message that names the culprit, nothing changed.
#include <limits>

#include "world.hpp"

namespace brainshift::test {
namespace {

class Arguments : public testing::Test {
 protected:
  World w;
  const std::int64_t too_many = std::int64_t(1) << 31;
  const std::int64_t huge = std::numeric_limits<std::int64_t>::max();

  void refused(brs_status status, brs_status expected, const std::string& part) {
    EXPECT_STREQ(brs_status_name(status), brs_status_name(expected)) << w.message();
    EXPECT_NE(w.message().find(part), std::string::npos) << "message: " << w.message();
  }

  brs_status mesh(std::int64_t nodes, std::int64_t tets, bool null = false) {
    brs_mesh* made = reinterpret_cast<brs_mesh*>(this);
    const brs_status status = brs_mesh_create(w.context, null ? nullptr : w.block.points.data(),
                                              nodes, w.block.tets.data(), tets, nullptr, 0, &made);
    EXPECT_EQ(made, nullptr);
    return status;
  }

  brs_status fixed(const std::int32_t* nodes, std::int64_t count, std::int32_t axes = BRS_AXES) {
    return brs_scene_add_fixed(w.scene, "x", nodes, count, axes, nullptr);
  }
};

TEST_F(Arguments, CountsBelowZeroOrBeyondTheIndexRangeAreRefused) {
  for (std::int64_t count : {std::int64_t(-1), too_many, huge, -huge}) {
    refused(mesh(count, 1), BRS_ERROR_SIZE, "nodes is " + std::to_string(count));
    refused(mesh(w.block.points.rows(), count), BRS_ERROR_SIZE, "tets");
    refused(fixed(w.base.data(), count), BRS_ERROR_SIZE, "nodes");
    double value = 0.0;
    refused(brs_stepper_displacement_at(w.stepper, &value, count, &value, nullptr), BRS_ERROR_SIZE,
            "points");
    std::int64_t faces = 0;
    refused(brs_mesh_faces(w.mesh, 0, nullptr, 0, nullptr, count, &faces), BRS_ERROR_SIZE, "faces");
  }
}

TEST_F(Arguments, NullArraysAreRefusedUnlessEmpty) {
  refused(mesh(5, 1, true), BRS_ERROR_NULL, "5 nodes is NULL");
  refused(mesh(0, 1, true), BRS_ERROR_EMPTY, "");
  refused(fixed(nullptr, 3), BRS_ERROR_NULL, "3 nodes is NULL");
  refused(fixed(nullptr, 0), BRS_ERROR_EMPTY, "'x'");
  double value[3] = {1.0, 1.0, 1.0};
  refused(brs_stepper_displacement_at(w.stepper, nullptr, 1, value, nullptr), BRS_ERROR_NULL, "");
  refused(brs_stepper_displacement_at(w.stepper, value, 1, nullptr, nullptr), BRS_ERROR_NULL, "");
  EXPECT_EQ(brs_stepper_displacement_at(w.stepper, nullptr, 0, nullptr, nullptr), BRS_OK);
  brs_compartment box = w.compartment();
  box.wall_points = nullptr;
  refused(brs_scene_add_compartment(w.scene, &box, nullptr), BRS_ERROR_NULL, "wall points");
}

TEST_F(Arguments, NullResultsAndStringsAreRefused) {
  refused(brs_scene_create(w.context, w.mesh, nullptr), BRS_ERROR_NULL, "scene is NULL");
  refused(brs_stepper_create(w.scene, nullptr, nullptr), BRS_ERROR_NULL, "stepper is NULL");
  refused(brs_stepper_snapshot(w.stepper, nullptr), BRS_ERROR_NULL, "snapshot is NULL");
  refused(brs_stepper_field(w.stepper, 0, nullptr, nullptr, nullptr), BRS_ERROR_NULL, "values");
  refused(brs_mesh_surface(w.mesh, nullptr, nullptr), BRS_ERROR_NULL, "triangles");
  refused(brs_mesh_faces(w.mesh, 0, nullptr, 0, nullptr, 0, nullptr), BRS_ERROR_NULL, "count");
  refused(brs_scene_set_gravity(w.scene, nullptr), BRS_ERROR_NULL, "gravity");
  refused(brs_stepper_set_gravity(w.stepper, nullptr), BRS_ERROR_NULL, "gravity");
  refused(brs_scene_set_material(w.scene, 0, nullptr), BRS_ERROR_NULL, "material");
  refused(brs_stepper_compartment(w.stepper, 0, nullptr), BRS_ERROR_NULL, "state");
  refused(brs_stepper_contact(w.stepper, w.contact, nullptr), BRS_ERROR_NULL, "state");
  refused(brs_scene_add_fixed(w.scene, nullptr, w.base.data(), 1, 7, nullptr), BRS_ERROR_NULL,
          "name is NULL");
  EXPECT_EQ(brs_context_create(BRS_VERSION, nullptr), BRS_ERROR_NULL);
}

TEST_F(Arguments, NumbersThatMeanNothingAreRefusedByName) {
  const double* values = nullptr;
  brs_surface* surface = nullptr;
  refused(brs_stepper_field(w.stepper, 99, &values, nullptr, nullptr), BRS_ERROR_INVALID_ARGUMENT,
          "99");
  refused(brs_stepper_field(w.stepper, -1, &values, nullptr, nullptr), BRS_ERROR_INVALID_ARGUMENT,
          "-1");
  refused(brs_stepper_set_csf(w.stepper, 0, 9, 0.0), BRS_ERROR_INVALID_ARGUMENT, "9");
  refused(brs_scene_set_csf(w.scene, 1e-6, 2, NAN), BRS_ERROR_INVALID_ARGUMENT, "2");
  refused(fixed(w.base.data(), 1, 8), BRS_ERROR_INVALID_ARGUMENT, "axes is 8");
  refused(brs_surface_create(w.context, 2, w.wall.points.data(), 8, w.wall.triangles.data(), 12,
                             nullptr, &surface),
          BRS_ERROR_INVALID_ARGUMENT, "2");
  refused(brs_stepper_set_enabled(w.stepper, 77, 1), BRS_ERROR_INVALID_ARGUMENT, "77");
}

TEST_F(Arguments, ErrorsOfTheLibraryArriveWithTheirCulprit) {
  w.block.tets(2, 1) = 9999;
  refused(mesh(w.block.points.rows(), w.block.tets.rows()), BRS_ERROR_INDEX_OUT_OF_RANGE, "9999");
  brs_material material = tissue();
  material.law = "rubber";
  refused(brs_scene_set_material(w.scene, 0, &material), BRS_ERROR_INVALID_ARGUMENT, "rubber");
  brs_material_init(&material, sizeof material);
  refused(brs_scene_set_material(w.scene, 0, &material), BRS_ERROR_NULL, "law");
  material.law = "linear";
  refused(brs_scene_set_material(w.scene, 0, &material), BRS_ERROR_NOT_FINITE, "young");
  material.young = -3.0;
  material.poisson = material.density = 0.0;
  refused(brs_scene_set_material(w.scene, 0, &material), BRS_ERROR_INVALID_ARGUMENT, "young");
  brs_compartment again = w.compartment();
  refused(brs_scene_add_compartment(w.scene, &again, nullptr), BRS_ERROR_INVALID_ARGUMENT, "'box'");
  again.name = "open";
  again.wall_triangle_count -= 1;
  refused(brs_scene_add_compartment(w.scene, &again, nullptr), BRS_ERROR_SURFACE_NOT_CLOSED,
          "'open'");
  refused(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_AIR_VOLUME, -1.0), BRS_ERROR_FLUID_VOLUME,
          "box");
  refused(brs_stepper_set_csf(w.stepper, 5, BRS_CSF_FULL, 0.0), BRS_ERROR_INDEX_OUT_OF_RANGE, "5");
}

TEST_F(Arguments, EveryLawTheHeaderNamesIsTaken) {
  for (const char* law : {"linear", "corotational", "st_venant_kirchhoff", "stable_neo_hookean",
                          "log_neo_hookean"}) {
    brs_material material = tissue();
    material.law = law;
    EXPECT_EQ(brs_scene_set_material(w.scene, 0, &material), BRS_OK) << law;
  }
}

TEST_F(Arguments, ASceneThatWasRefusedSomethingIsAsBefore) {
  w.good(w.solve_after_loss(5000.0));
  const std::vector<double> before = w.field(BRS_FIELD_DISPLACEMENT);
  EXPECT_LT(fixed(w.base.data(), -1), 0);
  EXPECT_LT(brs_scene_set_csf(w.scene, -1.0, BRS_CSF_SEPARATE, NAN), 0);
  brs_stepper* second = nullptr;
  w.good(brs_stepper_create(w.scene, nullptr, &second));
  brs_stepper_destroy(w.stepper);
  w.stepper = second;
  w.good(w.solve_after_loss(5000.0));
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), before);
}

TEST_F(Arguments, MoreFluidLostThanThereIsLeavesTheStateAlone) {
  w.good(w.solve_after_loss(5000.0));
  const std::vector<double> before = w.field(BRS_FIELD_DISPLACEMENT);
  const std::vector<double> pressure = w.field(BRS_FIELD_FLUID_PRESSURE);
  refused(w.solve_after_loss(1e9), BRS_ERROR_FLUID_VOLUME, "box");
  EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), before);
  EXPECT_EQ(w.field(BRS_FIELD_FLUID_PRESSURE), pressure);
}

TEST_F(Arguments, AMessageIsClearedByTheNextGoodCall) {
  EXPECT_LT(fixed(nullptr, 3), 0);
  EXPECT_NE(w.message(), "");
  w.good(brs_scene_set_balanced_reference(w.scene, 1));
  EXPECT_EQ(w.message(), "");
}

TEST_F(Arguments, LongMessagesAreCutBetweenCharacters) {
  std::string name;
  for (int i = 0; i < 2000; ++i) name += "\xC3\xA4";
  EXPECT_EQ(brs_scene_add_fixed(w.scene, name.c_str(), nullptr, 0, 7, nullptr), BRS_ERROR_EMPTY);
  EXPECT_GT(w.message().size(), 1000u);
  EXPECT_EQ(w.message().substr(w.message().size() - 2), "\xC3\xA4");
}

}  // namespace
}  // namespace brainshift::test
