// Quadratic meshes: nodes on edges, what is refused, where points lie when edges are bent.
#include <random>

#include <gtest/gtest.h>

#include "brainshift/error.hpp"
#include "mesh/quadratic_tet.hpp"
#include "support/expect_error.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

Mesh two_cells() { return test::make_mesh(test::make_box({2, 1, 1}, 2, 1, 1)).quadratic(); }

Points bent(const Mesh& mesh, double by) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> shift(-by, by);
  Points x = mesh.nodes();
  for (Index i = 0; i < mesh.node_count(); ++i) {
    for (int axis = 0; axis < 3 && !mesh.is_corner(i); ++axis) x(i, axis) += shift(random);
  }
  return x;
}

TEST(QuadraticMesh, HasANodeInTheMiddleOfEachEdgeInTheOrderOfVtk) {
  const Mesh linear = test::make_mesh(test::make_box({2, 1, 1}, 2, 1, 1));
  const Mesh mesh = linear.quadratic();
  ASSERT_TRUE(mesh.is_quadratic());
  EXPECT_FALSE(linear.is_quadratic());
  EXPECT_EQ(linear.edge_nodes().rows(), 0);
  const int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};  // VTK's
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const auto a = mesh.nodes().row(mesh.tets()(t, edges[e][0]));
      const auto b = mesh.nodes().row(mesh.tets()(t, edges[e][1]));
      EXPECT_EQ((mesh.nodes().row(mesh.edge_nodes()(t, e)) - 0.5 * (a + b)).norm(), 0.0);
    }
  }
  // Euler: a ball has V - E + F - T = 1.
  const Index edge_count = mesh.node_count() - linear.node_count();
  const Index faces = (4 * mesh.tet_count() + Index(mesh.surface().rows())) / 2;
  EXPECT_EQ(linear.node_count() - edge_count + faces - mesh.tet_count(), 1);
  EXPECT_NEAR(mesh.volume(), 2.0, 1e-14);
  EXPECT_EQ(mesh.surface(), linear.surface());
  EXPECT_EQ(mesh.component_count(), 1);
  for (Eigen::Index f = 0; f < mesh.surface().rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto a = mesh.nodes().row(mesh.surface()(f, k));
      const auto b = mesh.nodes().row(mesh.surface()(f, (k + 1) % 3));
      EXPECT_EQ((mesh.nodes().row(mesh.surface_edge_nodes()(f, k)) - 0.5 * (a + b)).norm(), 0.0);
    }
  }
}

TEST(QuadraticMesh, ShapeFunctionsAreOneAtTheirNodeAndRulesAreExact) {
  for (int a = 0; a < 10; ++a) {
    Eigen::Vector4d L = Eigen::Vector4d::Zero();
    if (a < 4) L[a] = 1.0;
    if (a >= 4) L[tet_edges[a - 4][0]] = L[tet_edges[a - 4][1]] = 0.5;
    EXPECT_EQ((quadratic_shape(L) - TenWeights::Unit(a)).norm(), 0.0);
  }
  // int L0^i L1^j L2^k L3^l / V = 6 i! j! k! l! / (i + j + k + l + 3)!
  const double factorial[] = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};
  const auto check = [&](const auto& rule, int degree) {
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j)
        for (int k = 0; i + j + k <= degree; ++k) {
          double sum = 0.0;
          for (const auto& p : rule) {
            sum += p.weight * std::pow(p.L[0], i) * std::pow(p.L[1], j) * std::pow(p.L[2], k);
          }
          const double exact =
              6 * factorial[i] * factorial[j] * factorial[k] / factorial[i + j + k + 3];
          EXPECT_NEAR(sum, exact, 1e-15) << degree << ": " << i << j << k;
        }
  };
  check(tet_rule_2(), 2);
  check(tet_rule_5(), 5);
}

TEST(QuadraticMesh, TurningAnInvertedTetTurnsItsEdges) {
  const Mesh mesh = two_cells();
  Tets tets = mesh.tets();
  EdgeNodes edges = mesh.edge_nodes();
  std::swap(tets(0, 2), tets(0, 3));
  std::swap(edges(0, 1), edges(0, 4));
  std::swap(edges(0, 2), edges(0, 3));
  test::expect_error(ErrorCode::inverted_element, {"tet 0"},
                     [&] { Mesh::with_edge_nodes(mesh.nodes(), tets, edges); });
  const Mesh turned = Mesh::with_edge_nodes(mesh.nodes(), tets, edges, {}, {true});
  EXPECT_EQ(turned.reoriented(), 1);
  EXPECT_EQ(turned.tets(), mesh.tets());
  EXPECT_EQ(turned.edge_nodes(), mesh.edge_nodes());
}

TEST(QuadraticMesh, RefusesEdgesThatDoNotFitTogether) {
  const Mesh mesh = two_cells();
  const auto refused = [&](ErrorCode code, const std::string& culprit, const EdgeNodes& edges) {
    test::expect_error(code, {culprit},
                       [&] { Mesh::with_edge_nodes(mesh.nodes(), mesh.tets(), edges); });
  };
  EdgeNodes edges = mesh.edge_nodes();
  edges(3, 2) = mesh.node_count();
  refused(ErrorCode::index_out_of_range, "tet 3 refers to node", edges);
  edges = mesh.edge_nodes();
  edges(3, 2) = mesh.tets()(0, 0);
  refused(ErrorCode::invalid_argument, "is a corner", edges);
  edges = mesh.edge_nodes();
  std::swap(edges(3, 4), edges(3, 5));
  refused(ErrorCode::invalid_argument, "edge", edges);
  refused(ErrorCode::size_mismatch, "tets", mesh.edge_nodes().topRows(2));
  refused(ErrorCode::empty, "no edge nodes", EdgeNodes(0, 6));
  // An edge bent so far that the tet folds over itself.
  Points nodes = mesh.nodes();
  nodes.row(mesh.edge_nodes()(0, 0)) += Eigen::RowVector3d(0.0, 0.0, 5.0);
  test::expect_error(ErrorCode::inverted_element, {"folds over itself"},
                     [&] { Mesh::with_edge_nodes(nodes, mesh.tets(), mesh.edge_nodes()); });
}

// Gmsh numbers the last two edges the other way round; taken for VTK's they do not fit together.
TEST(QuadraticMesh, TheOrderOfGmshIsTurnedIntoThatOfVtk) {
  const Mesh mesh = two_cells();
  const int gmsh[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  EdgeNodes edges(mesh.tet_count(), 6);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int e = 0; e < 6; ++e) {
      for (int v = 0; v < 6; ++v) {
        if (std::minmax(gmsh[e][0], gmsh[e][1]) == std::minmax(tet_edges[v][0], tet_edges[v][1])) {
          edges(t, e) = mesh.edge_nodes()(t, v);
        }
      }
    }
  }
  EXPECT_EQ(from_gmsh_order(edges), mesh.edge_nodes());
  EXPECT_THROW(Mesh::with_edge_nodes(mesh.nodes(), mesh.tets(), edges), Error);
}

// Bent positions: a material point is found where it went, and its value comes back.
TEST(QuadraticMesh, FindsMaterialPointsInBentTets) {
  const Mesh mesh = two_cells();
  const Points x = bent(mesh, 0.06);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  Points there(200, 3);
  std::vector<Interpolation> known;
  for (Eigen::Index i = 0; i < there.rows(); ++i) {
    Eigen::Vector4d L(part(random), part(random), part(random), part(random));
    if (i % 4 == 0) L[Eigen::Index(i / 4 % 4)] = 0.0;  // on a face
    L /= L.sum();
    known.push_back(mesh.interpolation(Index(i) % mesh.tet_count(), L));
    there.row(i) = known.back().of(x).transpose();
  }
  const Location found = mesh.locate_deformed(there, x);
  for (Eigen::Index i = 0; i < there.rows(); ++i) {
    ASSERT_GE(found.tet[std::size_t(i)], 0) << i;
    const Interpolation at =
        mesh.interpolation(found.tet[std::size_t(i)], found.weights.row(i).transpose());
    EXPECT_LE((at.of(x) - there.row(i).transpose()).norm(), 1e-11) << i;
    EXPECT_LE((at.of(mesh.nodes()) - known[std::size_t(i)].of(mesh.nodes())).norm(), 1e-10) << i;
  }
  Points outside(2, 3);
  outside << -0.2, 0.5, 0.5, 9, 9, 9;
  EXPECT_EQ(mesh.locate_deformed(outside, x).tet, Indices({-1, -1}));
  Points near(1, 3);
  near << -1e-10, 0.3, 0.4;  // within the tolerance of a straight face
  EXPECT_GE(mesh.locate(near).tet[0], 0);
  EXPECT_EQ(mesh.locate(near, 1e-11).tet[0], -1);
}

}  // namespace
}  // namespace brainshift
