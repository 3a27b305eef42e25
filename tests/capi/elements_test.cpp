// Quadratic meshes, the choice of element and the error estimate, as in C++, bit for bit.
#include "cpp_scene.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

// The block on quadratic tets, one of whose edges bulges.
struct Curved {
  Mesh straight = Mesh(block_shape().points, block_shape().tets).quadratic();
  Points nodes = straight.nodes();
  Tets tets = straight.tets();
  EdgeNodes edges = straight.edge_nodes();
  Curved() { nodes(edges(0, 0), 2) += 0.5; }
};

class Elements : public testing::Test {
 protected:
  World w;
  Curved c;
  brs_mesh* made = nullptr;
  ~Elements() override { brs_mesh_destroy(made); }

  brs_status create(const std::int32_t* edges, std::int32_t order, std::int64_t tets,
                    std::int64_t nodes) {
    brs_mesh_destroy(made);
    made = w.mesh;
    return brs_mesh_create_quadratic(w.context, c.nodes.data(), nodes, c.tets.data(), edges, tets,
                                     order, nullptr, 0, &made);
  }
  brs_status create(const EdgeNodes& edges, std::int32_t order = BRS_EDGES_VTK) {
    return create(edges.data(), order, c.tets.rows(), c.nodes.rows());
  }
  void refused(brs_status found, brs_status expected, const std::string& part) {
    EXPECT_STREQ(brs_status_name(found), brs_status_name(expected)) << w.message();
    EXPECT_NE(w.message().find(part), std::string::npos) << w.message();
    EXPECT_EQ(made, nullptr);
  }

  void expect_same(brs_mesh* mesh, const Mesh& cpp) {
    brs_mesh_info info;
    brs_mesh_info_init(&info, sizeof info);
    w.good(brs_mesh_describe(mesh, &info));
    ASSERT_EQ(info.node_count, cpp.node_count());
    ASSERT_EQ(info.tet_count, cpp.tet_count());
    ASSERT_EQ(info.surface_count, cpp.surface().rows());
    ASSERT_EQ(info.quadratic_tet_count, cpp.edge_nodes().rows());
    ASSERT_EQ(info.quadratic_face_count, cpp.surface_edge_nodes().rows());
    EXPECT_EQ(info.volume, cpp.volume());
    expect_same_bits(cpp.nodes(), info.nodes);
    expect_same_bits(cpp.tets(), info.tets);
    expect_same_bits(cpp.edge_nodes(), info.edge_nodes);
    expect_same_bits(cpp.surface_edge_nodes(), info.surface_edge_nodes);
    EXPECT_EQ(cpp.surface_tets(),
              Indices(info.surface_tets, info.surface_tets + info.surface_count));
  }

  // Solves after a loss; another stepper takes the place of the one in the world.
  void expect_same_solve(brs_scene* scene, const Scene& cpp_scene) {
    brs_stepper_destroy(std::exchange(w.stepper, nullptr));
    w.good(brs_stepper_create(scene, nullptr, &w.stepper));
    w.good(w.solve_after_loss(5000.0));
    Stepper cpp(cpp_scene);
    cpp.csf().set_lost_volume(0, 5000.0);
    ASSERT_TRUE(cpp.solve_static().converged());
    const Points& u = cpp.displacement();
    EXPECT_EQ(w.field(BRS_FIELD_DISPLACEMENT), std::vector<double>(u.data(), u.data() + u.size()));
    const Eigen::VectorXd p = cpp.fluid_pressure();
    EXPECT_EQ(w.field(BRS_FIELD_FLUID_PRESSURE),
              std::vector<double>(p.data(), p.data() + p.size()));
    brs_mesh* mesh = nullptr;
    w.good(brs_stepper_mesh(w.stepper, &mesh));
    expect_same(mesh, cpp.mesh());
    brs_mesh_destroy(mesh);
  }
};

TEST_F(Elements, QuadraticMeshesFromArraysAreThoseOfTheCppLibrary) {
  const Mesh cpp = Mesh::with_edge_nodes(c.nodes, c.tets, c.edges);
  w.good(create(c.edges));
  expect_same(made, cpp);
  EdgeNodes gmsh = c.edges;
  gmsh.col(4).swap(gmsh.col(5));
  w.good(create(gmsh, BRS_EDGES_GMSH));
  expect_same(made, cpp);
  EXPECT_NE(create(gmsh, BRS_EDGES_VTK), BRS_OK);
}

TEST_F(Elements, QuadraticMeshesFromTurnedTetsKeepTheirEdges) {
  const Mesh cpp = Mesh::with_edge_nodes(c.nodes, c.tets, c.edges);
  c.tets.col(0).swap(c.tets.col(1));  // edges 12 and 02, 03 and 13 change places
  c.edges.col(1).swap(c.edges.col(2));
  c.edges.col(3).swap(c.edges.col(4));
  refused(create(c.edges), BRS_ERROR_INVERTED_ELEMENT, "tet 0");
  w.good(brs_mesh_create_quadratic(w.context, c.nodes.data(), c.nodes.rows(), c.tets.data(),
                                   c.edges.data(), c.tets.rows(), BRS_EDGES_VTK, nullptr, 1,
                                   &made));
  brs_mesh_info info;
  brs_mesh_info_init(&info, sizeof info);
  w.good(brs_mesh_describe(made, &info));
  EXPECT_EQ(info.reoriented, info.tet_count);
  EXPECT_NEAR(info.volume, cpp.volume(), 1e-12 * cpp.volume());
}

TEST_F(Elements, MeshesWithANodeInTheMiddleOfEachEdgeAreThoseOfTheCppLibrary) {
  w.good(brs_mesh_quadratic(w.mesh, &made));
  expect_same(made, c.straight);
  brs_mesh* again = nullptr;
  w.good(brs_mesh_quadratic(made, &again));
  expect_same(again, c.straight);
  brs_mesh_destroy(again);
  expect_same(w.mesh, Mesh(w.block.points, w.block.tets));
  EXPECT_EQ(brs_mesh_quadratic(w.mesh, nullptr), BRS_ERROR_NULL);
}

TEST_F(Elements, QuadraticMeshesThatMakeNoSenseAreRefused) {
  const std::int64_t tets = c.tets.rows(), nodes = c.nodes.rows();
  for (std::int64_t count : {std::int64_t(-1), std::int64_t(1) << 31, INT64_MAX, INT64_MIN}) {
    refused(create(c.edges.data(), 0, count, nodes), BRS_ERROR_SIZE, "tets");
    refused(create(c.edges.data(), 0, tets, count), BRS_ERROR_SIZE, "nodes");
  }
  refused(create(nullptr, 0, tets, nodes), BRS_ERROR_NULL, "edge nodes");
  refused(create(c.edges.data(), 2, tets, nodes), BRS_ERROR_INVALID_ARGUMENT, "number 2");
  EdgeNodes wrong = c.edges;
  wrong(3, 1) = Index(nodes);
  refused(create(wrong), BRS_ERROR_INDEX_OUT_OF_RANGE, "tet 3");
  wrong = c.edges;
  wrong(0, 0) = wrong(0, 1);
  refused(create(wrong), BRS_ERROR_INVALID_ARGUMENT, "edge");
  c.nodes(c.edges(0, 0), 2) += 40.0;
  refused(create(c.edges), BRS_ERROR_INVERTED_ELEMENT, "tet");
}

TEST_F(Elements, OfLinearTetsWithNodalVolumesSolveAsInCpp) {
  Scene cpp = cpp_scene();
  cpp.volume_strain = VolumeStrain::nodal;
  w.good(brs_scene_set_volume_strain(w.scene, BRS_VOLUME_STRAIN_NODAL));
  expect_same_solve(w.scene, cpp);
  const std::vector<double> nodal = w.field(BRS_FIELD_DISPLACEMENT);
  w.good(brs_scene_set_volume_strain(w.scene, BRS_VOLUME_STRAIN_ELEMENT));
  expect_same_solve(w.scene, cpp_scene());
  EXPECT_NE(w.field(BRS_FIELD_DISPLACEMENT), nodal);
  for (std::int32_t number : {-1, 2})
    EXPECT_EQ(brs_scene_set_volume_strain(w.scene, number), BRS_ERROR_INVALID_ARGUMENT) << number;
}

TEST_F(Elements, OfQuadraticScenesSolveAsInCpp) {
  brs_scene* scene = nullptr;
  w.good(brs_scene_quadratic(w.scene, &scene));
  expect_same_solve(scene, quadratic(cpp_scene()));
  // A group keeps its id, and has the nodes on its edges.
  brs_contact_state contact;
  brs_contact_state_init(&contact, sizeof contact);
  w.good(brs_stepper_contact(w.stepper, w.contact, &contact));
  EXPECT_GT(contact.count, std::int64_t(w.sides.size()));
  EXPECT_EQ(Indices(contact.nodes, contact.nodes + contact.count),
            quadratic(cpp_scene()).constraints.group(w.contact).nodes);
  w.good(brs_scene_set_volume_strain(scene, BRS_VOLUME_STRAIN_NODAL));
  brs_stepper* none = w.stepper;
  EXPECT_EQ(brs_stepper_create(scene, nullptr, &none), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(none, nullptr);
  brs_scene_destroy(scene);
  expect_same_solve(w.scene, cpp_scene());  // the linear one is what it was
  EXPECT_EQ(brs_scene_quadratic(w.scene, nullptr), BRS_ERROR_NULL);
}

TEST_F(Elements, EstimateTheirErrorAsInCpp) {
  const Points at = (Points(3, 3) << 15, 15, 29, 4, 20, 11, 99, 99, 99).finished();
  double errors[3] = {}, corrections[9] = {}, alone[3] = {};
  w.good(w.solve_after_loss(5000.0));
  EXPECT_EQ(brs_stepper_estimate_error(w.stepper, at.data(), 3, errors, corrections), BRS_OUTSIDE);
  EXPECT_EQ(w.message(), "1 of 3 points lie outside the mesh");
  Stepper cpp(cpp_scene());
  cpp.csf().set_lost_volume(0, 5000.0);
  ASSERT_TRUE(cpp.solve_static().converged());
  const ErrorEstimate expected = cpp.estimate_error(at);
  EXPECT_GT(errors[0], 0.0);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(errors[i], expected.error[i]);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(corrections[i], expected.correction.data()[i]);
  EXPECT_TRUE(std::isnan(errors[2]) && std::isnan(corrections[8]));
  w.good(brs_stepper_estimate_error(w.stepper, at.data(), 2, alone, nullptr));
  EXPECT_EQ(alone[1], errors[1]);
  EXPECT_EQ(alone[2], 0.0);  // no more than was asked
}

TEST_F(Elements, RefuseAnErrorEstimateThatMakesNoSense) {
  double point[3] = {15.0, 15.0, 15.0}, error = -1.0;
  const auto estimate = [&](const double* at, std::int64_t count, double* into) {
    return brs_stepper_estimate_error(w.stepper, at, count, into, nullptr);
  };
  for (std::int64_t count : {std::int64_t(-1), std::int64_t(1) << 31, INT64_MAX, INT64_MIN})
    EXPECT_EQ(estimate(point, count, &error), BRS_ERROR_SIZE);
  EXPECT_EQ(estimate(nullptr, 1, &error), BRS_ERROR_NULL);
  EXPECT_EQ(estimate(point, 1, nullptr), BRS_ERROR_NULL);
  w.good(brs_stepper_set_csf(w.stepper, 0, BRS_CSF_LOST_VOLUME, 5000.0));
  w.good(brs_stepper_step(w.stepper, 0.02, nullptr));
  EXPECT_EQ(estimate(point, 1, &error), BRS_ERROR_INVALID_ARGUMENT);  // in motion
  EXPECT_EQ(error, -1.0);
}

}  // namespace
}  // namespace brainshift::test
