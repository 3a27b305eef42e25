// Energy, forces and tangent of assembled tissue: each is the derivative of the one before, a
// constant strain is reproduced, a rigid motion is free.
#include "tissue/tissue.hpp"

#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "support/laws.hpp"
#include "support/scenes.hpp"

namespace brainshift {
namespace {

// A cube of irregular tets: inner nodes moved by up to a fifth of an edge, two regions.
Mesh irregular_cube(double size = 10.0, int cells = 3) {
  auto box = test::make_box(Vec3::Constant(size), cells, cells, cells);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.2 * size / cells, 0.2 * size / cells);
  for (Eigen::Index i = 0; i < box.points.rows(); ++i) {
    const auto p = box.points.row(i);
    if (p.minCoeff() > 0.0 && p.maxCoeff() < size) {
      for (int axis = 0; axis < 3; ++axis) box.points(i, axis) += shift(random);
    }
  }
  Indices regions;
  for (Eigen::Index t = 0; t < box.tets.rows(); ++t) regions.push_back(t % 3 == 0 ? 4 : 0);
  return test::make_mesh(box, regions);
}

// Linear tets, those with volumes averaged at nodes, quadratic ones, and those with bent edges.
struct Elements {
  const char* name;
  Mesh (*mesh)(int cells);
  VolumeStrain volume;
};

Mesh linear_cube(int cells) { return irregular_cube(10.0, cells); }
Mesh quadratic_cube(int cells) { return irregular_cube(10.0, cells).quadratic(); }
Mesh bent_cube(int cells) {
  const Mesh straight = quadratic_cube(cells);
  Points nodes = straight.nodes();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.3 / cells, 0.3 / cells);
  for (Index i = 0; i < straight.node_count(); ++i) {
    if (straight.is_corner(i)) continue;
    for (int axis = 0; axis < 3; ++axis) nodes(i, axis) += shift(random);
  }
  return Mesh::with_edge_nodes(nodes, straight.tets(), straight.edge_nodes(), straight.regions());
}

const Elements all_elements[] = {{"linear", linear_cube, VolumeStrain::element},
                                 {"nodal volume", linear_cube, VolumeStrain::nodal},
                                 {"quadratic", quadratic_cube, VolumeStrain::element},
                                 {"bent", bent_cube, VolumeStrain::element}};

std::vector<std::pair<Index, Material>> two_materials(Law law) {
  return {{4, Material(law, 2.0, 0.3, 2e-6)}, {0, Material(law, 6.0, 0.45, 1e-6)}};
}

std::vector<std::pair<Index, Material>> one_material(Law law) {
  return {{4, Material(law, 6.0, 0.45, 1e-6)}, {0, Material(law, 6.0, 0.45, 1e-6)}};
}

Points random_motion(const Mesh& mesh, double by) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-by, by);
  return Points::NullaryExpr(mesh.node_count(), 3, [&] { return shift(random); });
}

Points force_at(const Tissue& tissue, const Points& u) {
  return tissue.response(u).force;
}

Indices identity(Index count) {
  Indices same(static_cast<std::size_t>(count));
  std::iota(same.begin(), same.end(), 0);
  return same;
}

Eigen::MatrixXd dense(const BlockMatrix& K) {
  Eigen::MatrixXd full(3 * K.blocks(), 3 * K.blocks());
  Eigen::VectorXd y;
  for (Index j = 0; j < full.cols(); ++j) {
    K.multiply(Eigen::VectorXd::Unit(full.cols(), j), y);
    full.col(j) = y;
  }
  return full;
}

TEST(Tissue, ForceIsTheGradientOfTheEnergy) {
  const double h = 1e-6 * 5.0;  // of an edge
  for (const Elements& elements : all_elements) {
    const Mesh mesh = elements.mesh(2);
    const double by = mesh.is_quadratic() ? 0.15 : 0.5;
    for (Law law : test::all_laws) {
      const Tissue tissue(mesh, two_materials(law), elements.volume);
      const Points u = random_motion(mesh, by), f = force_at(tissue, u);
      ASSERT_GT(tissue.jacobians(u).minCoeff(), 0.0);
      for (Eigen::Index j = 0; j < u.size(); ++j) {
        Points plus = u, minus = u;
        plus.data()[j] += h;
        minus.data()[j] -= h;
        // rel. 1e-6 of the largest entry
        EXPECT_NEAR((tissue.energy(plus) - tissue.energy(minus)) / (2 * h), f.data()[j],
                    1e-6 * f.cwiseAbs().maxCoeff())
            << elements.name << " " << to_string(law);
      }
    }
  }
}

TEST(Tissue, TangentIsTheGradientOfTheForceAlsoWithTiedNodes) {
  // Node 26 (a corner) is tied to node 0 (the opposite corner): they share a block.
  const double h = 1e-6 * 5.0;
  for (const Elements& elements : all_elements) {
    const Mesh mesh = elements.mesh(2);
    const double by = mesh.is_quadratic() ? 0.15 : 0.5;
    for (bool tied : {false, true}) {
      Indices slots = identity(mesh.node_count());
      if (tied) {
        slots[26] = 0;
        for (Index i = 27; i < mesh.node_count(); ++i) slots[std::size_t(i)] = i - 1;
      }
      const Index blocks = mesh.node_count() - (tied ? 1 : 0);
      std::vector<Indices> near(static_cast<std::size_t>(blocks));
      for (Index i = 0; i < blocks; ++i)
        for (Index j = 0; j < blocks; ++j)
          if (i != j) near[std::size_t(i)].push_back(j);
      for (Law law : test::all_laws) {
        const Tissue tissue(mesh, two_materials(law), elements.volume);
        Points u = random_motion(mesh, by);
        if (tied) u.row(26) = u.row(0);
        BlockMatrix matrix(near);
        const ElementMap map = tissue.map_elements(slots, matrix);
        tissue.tangent(u, false, map, matrix);
        const Eigen::MatrixXd K = dense(matrix);
        EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
        const Index every = mesh.is_quadratic() ? 7 : 1;  // columns, to save time
        for (Index j = 0; j < 3 * blocks; j += every) {
          Points plus = u, minus = u;
          for (Index n = 0; n < mesh.node_count(); ++n) {
            if (slots[std::size_t(n)] != j / 3) continue;
            plus(n, j % 3) += h;
            minus(n, j % 3) -= h;
          }
          const Points slope = (force_at(tissue, plus) - force_at(tissue, minus)) / (2 * h);
          Eigen::VectorXd column = Eigen::VectorXd::Zero(3 * blocks);
          for (Index n = 0; n < mesh.node_count(); ++n) {
            column.segment<3>(3 * slots[std::size_t(n)]) += slope.row(n).transpose();
          }
          EXPECT_LT((K.col(j) - column).cwiseAbs().maxCoeff(), 1e-6 * K.cwiseAbs().maxCoeff())
              << elements.name << " " << to_string(law);
        }
      }
    }
  }
}

TEST(Tissue, DefiniteTangentHasNoNegativeEigenvalue) {
  for (const Elements& elements : all_elements) {
    const Mesh mesh = elements.mesh(2);
    const bool large = mesh.is_quadratic();
    std::vector<Indices> near(std::size_t(mesh.node_count()));
    for (Index i = 0; i < mesh.node_count(); ++i)
      for (Index j = 0; j < mesh.node_count(); ++j)
        if (i != j) near[std::size_t(i)].push_back(j);
    for (Law law : test::all_laws) {
      const Tissue tissue(mesh, two_materials(law), elements.volume);
      // Strong motion: some tets are inverted; or, for a law without inversion, all of them
      // pressed to a third of their volume.
      const Points u = test::allows_inversion(law)
                           ? random_motion(mesh, large ? 1.5 : 2.5)
                           : Points(random_motion(mesh, large ? 0.05 : 0.1) + mesh.nodes() * -0.3);
      ASSERT_EQ(tissue.jacobians(u).minCoeff() < 0.0, test::allows_inversion(law))
          << to_string(law);
      const auto lowest = [&](bool definite) {  // eigenvalue, over the largest entry
        BlockMatrix matrix(near);
        tissue.tangent(u, definite, tissue.map_elements(identity(mesh.node_count()), matrix), matrix);
        const Eigen::MatrixXd K = dense(matrix);
        return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues()[0] /
               K.cwiseAbs().maxCoeff();
      };
      EXPECT_GE(lowest(true), -1e-12) << elements.name << " " << to_string(law);
      // The others have something to project, on plain linear tets at least.
      if (law == Law::linear || &elements != all_elements) continue;
      EXPECT_LT(lowest(false), -1e-3) << elements.name << " " << to_string(law);
    }
  }
}

TEST(Tissue, OneInvertedTetMakesTheEnergyInfiniteWhereALawHasNone) {
  const Mesh mesh = irregular_cube();
  const Tissue tissue(mesh, two_materials(Law::log_neo_hookean));
  Points u = random_motion(mesh, 0.1);
  ASSERT_TRUE(std::isfinite(tissue.energy(u)) && force_at(tissue, u).allFinite());
  const Index node = mesh.tets()(mesh.tet_count() / 2, 0);
  u.row(node) += Vec3(9, 9, 9).transpose();  // through the faces opposite
  ASSERT_LT(tissue.jacobians(u).minCoeff(), 0.0);
  EXPECT_EQ(tissue.energy(u), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(force_at(tissue, u).row(node).allFinite());
}

TEST(PatchTest, AnAffineMotionGivesConstantStressAndNoForceInside) {
  for (const Elements& elements : all_elements) {
    if (elements.mesh == bent_cube) continue;  // its volume is not that of its faces' corners
    const Mesh mesh = elements.mesh(3);
    Mat3 G;
    G << 0.10, -0.05, 0.02, 0.07, -0.08, 0.03, -0.04, 0.06, 0.05;
    const Points u = mesh.nodes() * G.transpose();
    for (Law law : test::all_laws) {
      const Tissue tissue(mesh, one_material(law), elements.volume);
      const Points f = force_at(tissue, u);
      const Mat3 P = Material(law, 6.0, 0.45, 0.0).stress(G);
      const double scale = P.cwiseAbs().maxCoeff() * 10.0 * 10.0;
      // Nodes inside feel nothing; the whole virial is that of the constant stress.
      const Indices outside = test::surface_nodes(mesh);
      std::vector<bool> on_surface(std::size_t(mesh.node_count()), false);
      for (Index i : outside) on_surface[std::size_t(i)] = true;
      for (Index i = 0; i < mesh.node_count(); ++i) {
        if (on_surface[std::size_t(i)]) continue;
        EXPECT_LE(f.row(i).norm(), 1e-12 * scale) << to_string(law);
      }
      const Mat3 virial = f.transpose() * mesh.nodes() / mesh.volume();
      EXPECT_LE((virial - P).cwiseAbs().maxCoeff(), 1e-12 * P.cwiseAbs().maxCoeff())
          << to_string(law);
      EXPECT_NEAR(tissue.energy(u), mesh.volume() * Material(law, 6.0, 0.45, 0.0).energy(G),
                  1e-12 * tissue.energy(u));
    }
  }
}

TEST(RigidMotion, CostsNothingForTheNonlinearLaws) {
  for (const Elements& elements : all_elements) {
    const Mesh mesh = elements.mesh(3);
    for (double angle : {1e-3, 0.7, 2.9}) {
      const Mat3 R = Eigen::AngleAxisd(angle, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
      Points u = mesh.nodes() * (R - Mat3::Identity()).transpose();
      u.rowwise() += Vec3(3, -7, 11).transpose();
      for (Law law : test::nonlinear_laws) {
        const Tissue tissue(mesh, two_materials(law), elements.volume);
        // 1e-12 E L^2; the largest coefficient counts, 2 (lambda + mu) ~ 40 kPa
        EXPECT_LE(force_at(tissue, u).cwiseAbs().maxCoeff(), 1e-12 * 40.0 * 100.0)
            << elements.name << " " << to_string(law) << " " << angle;
      }
    }
  }
}

TEST(RigidMotion, ATranslationCostsNothingForAnyLaw) {
  const Mesh mesh = irregular_cube();
  Points u(mesh.node_count(), 3);
  u.rowwise() = Vec3(3, -7, 11).transpose();
  for (Law law : test::all_laws) {
    EXPECT_LE(force_at(Tissue(mesh, two_materials(law)), u).cwiseAbs().maxCoeff(), 1e-12 * 600.0);
  }
}

// Forces are formed from grad u, not F - I: the odd part of the force of a tiny motion is that of the
// linear law, up to the square of the motion. F would lose 1e-4 of it at 1e-12.
TEST(Tissue, TinyDisplacementsKeepTheirDigits) {
  const Mesh mesh = irregular_cube();
  const Points u = random_motion(mesh, 1.0);
  const Tissue hooke(mesh, two_materials(Law::linear));
  for (Law law : test::all_laws) {
    const Tissue tissue(mesh, two_materials(law));
    for (double size : {1e-6, 1e-9, 1e-12, 1e-14}) {
      const Points linear = force_at(hooke, size * u);
      const Points odd = 0.5 * (force_at(tissue, size * u) - force_at(tissue, -size * u));
      // some ten terms of size lambda per node, |grad u| of order 1: third order below 100
      EXPECT_LE((odd - linear).cwiseAbs().maxCoeff(),
                (1e-13 + 100.0 * size * size) * linear.cwiseAbs().maxCoeff())
          << to_string(law) << " " << size;
    }
  }
}

TEST(Tissue, RelabellingNodesAndTurningTetsChangesNothing) {
  const Mesh mesh = irregular_cube();
  const Index n = mesh.node_count();
  std::mt19937 random(11);
  Indices to = identity(n);
  std::shuffle(to.begin(), to.end(), random);
  Points nodes(n, 3), u(n, 3);
  const Points u0 = random_motion(mesh, 0.3);
  for (Index i = 0; i < n; ++i) {
    nodes.row(to[std::size_t(i)]) = mesh.nodes().row(i);
    u.row(to[std::size_t(i)]) = u0.row(i);
  }
  Tets tets(mesh.tet_count(), 4);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const int turn[4] = {1, 2, 0, 3};  // an even permutation keeps the orientation
    for (int a = 0; a < 4; ++a) {
      tets(t, a) = to[std::size_t(mesh.tets()(t, t % 2 ? turn[a] : a))];
    }
  }
  const Mesh other(nodes, tets, mesh.regions());
  for (Law law : test::all_laws) {
    const Tissue a(mesh, two_materials(law)), b(other, two_materials(law));
    EXPECT_NEAR(a.energy(u0), b.energy(u), 1e-13 * a.energy(u0));
    const Points fa = force_at(a, u0), fb = force_at(b, u);
    for (Index i = 0; i < n; ++i) {
      EXPECT_LE((fa.row(i) - fb.row(to[std::size_t(i)])).norm(),
                1e-13 * fa.cwiseAbs().maxCoeff() * 8)
          << to_string(law);
    }
  }
}

TEST(Tissue, GravityCarriesTheMass) {
  for (const Elements& elements : all_elements) {
    const Mesh mesh = elements.mesh(3);
    const Tissue tissue(mesh, two_materials(Law::linear), elements.volume);
    // The mass of bent tets is that of their four points, 1e-4 off the exact volume here.
    const double rule = elements.mesh == bent_cube ? 1e-4 : 1e-13;
    const double mass = 2e-6 * mesh.volume(4) + 1e-6 * mesh.volume(0);
    EXPECT_NEAR(tissue.mass(), mass, rule * mass);
    EXPECT_NEAR(tissue.node_masses().sum(), tissue.mass(), 1e-13 * mass);
    EXPECT_GT(tissue.node_masses().minCoeff(), 0.0);
    const Vec3 g(1, -2, 3);
    const Points force = tissue.gravity_force(g);
    EXPECT_LE((force.colwise().sum().transpose() - mass * g).norm(), 1e-12 * mass);
  }
}

TEST(Tissue, JacobianIsTheChangeOfVolume) {
  const Mesh mesh = irregular_cube();
  const Tissue tissue(mesh, two_materials(Law::linear));
  const Points u = random_motion(mesh, 0.4);
  const Eigen::VectorXd J = tissue.jacobians(u);
  const auto volume = [&](const Points& x, Index t) {
    Vec3 p[4];
    for (int a = 0; a < 4; ++a) p[a] = x.row(mesh.tets()(t, a)).transpose();
    return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
  };
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    EXPECT_NEAR(J[t], volume(mesh.nodes() + u, t) / volume(mesh.nodes(), t), 1e-12);
  }
}

}  // namespace
}  // namespace brainshift
