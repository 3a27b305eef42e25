// Conjugate gradients: the solution, how many iterations it takes, and matrices that are not positive.
#include "linear/conjugate_gradients.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace brainshift {
namespace {

using Vector = Eigen::VectorXd;

// Diagonal, with as many different entries as `kinds`; the last one as given.
Vector diagonal(Eigen::Index size, int kinds, double last) {
  Vector d(size);
  for (Eigen::Index i = 0; i < size; ++i) d[i] = 1.0 + double(i % kinds);
  d[size - 1] = last;
  return d;
}

struct Solved {
  ConjugateGradients result;
  Vector y;
};

Solved solve(const Vector& A, const Vector& b, double aim, int most, const Vector& inverse) {
  const auto times = [&](const Vector& p) -> Vector { return A.cwiseProduct(p); };
  const auto precondition = [&](const Vector& r) -> Vector { return inverse.cwiseProduct(r); };
  Solved run{{}, Vector::Zero(b.size())};
  run.result = conjugate_gradients(times, precondition, b, precondition(b), aim, most, run.y);
  return run;
}

TEST(ConjugateGradients, EndAfterAsManyIterationsAsThereAreEigenvalues) {
  const Vector A = diagonal(60, 7, 3.0), b = Vector::LinSpaced(60, -1.0, 2.0), none = Vector::Ones(60);
  const Solved run = solve(A, b, 1e-24 * b.squaredNorm(), 60, none);
  EXPECT_TRUE(run.result.positive);
  EXPECT_EQ(run.result.iterations, 7);
  EXPECT_LT((run.y - b.cwiseQuotient(A)).norm(), 1e-12 * b.norm());
}

TEST(ConjugateGradients, NeedOneIterationWithTheInverse) {
  const Vector A = diagonal(60, 7, 3.0), b = Vector::LinSpaced(60, -1.0, 2.0);
  const Solved run = solve(A, b, 1e-24 * b.squaredNorm(), 60, A.cwiseInverse());
  EXPECT_EQ(run.result.iterations, 1);
  EXPECT_LT((run.y - b.cwiseQuotient(A)).norm(), 1e-13 * b.norm());
}

TEST(ConjugateGradients, EndWhereAimedAtOrWhenTheyMayNotGoOn) {
  const Vector A = diagonal(60, 20, 3.0), b = Vector::LinSpaced(60, -1.0, 2.0), none = Vector::Ones(60);
  const Solved loose = solve(A, b, 1e-2 * b.squaredNorm(), 60, none), cut = solve(A, b, 0.0, 3, none);
  EXPECT_LE(loose.result.rho, 1e-2 * b.squaredNorm());
  EXPECT_LT(loose.result.iterations, 20);
  EXPECT_EQ(cut.result.iterations, 3);
  EXPECT_NEAR(cut.result.rho, (b - A.cwiseProduct(cut.y)).squaredNorm(), 1e-12 * b.squaredNorm());
}

TEST(ConjugateGradients, SayWhereAMatrixIsNotPositive) {
  const Vector A = diagonal(60, 7, -100.0), b = Vector::LinSpaced(60, -1.0, 2.0), none = Vector::Ones(60);
  EXPECT_FALSE(solve(A, b, 1e-24 * b.squaredNorm(), 60, none).result.positive);
}

}  // namespace
}  // namespace brainshift
