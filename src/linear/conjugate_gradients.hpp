// Preconditioned conjugate gradients (Hestenes, Stiefel 1952) on A y = b, A and the preconditioner positive
// definite and given by what they do to a vector.
#pragma once

#include <Eigen/Core>

namespace brainshift {

struct ConjugateGradients {
  int iterations = 0;
  double rho = 0.0;       // r . P r of the residual r = b - A y
  bool positive = true;   // false: a direction without curvature was met, A is not positive definite
};

// Goes on from y, with the residual r there and z = P r, until rho <= aim, for `most` iterations at most.
template <class Times, class Precondition>
ConjugateGradients conjugate_gradients(const Times& times, const Precondition& precondition, Eigen::VectorXd r,
                                       Eigen::VectorXd z, double aim, int most, Eigen::VectorXd& y) {
  ConjugateGradients run;
  run.rho = r.dot(z);
  Eigen::VectorXd p = z;
  while (run.rho > aim && run.iterations < most) {
    const Eigen::VectorXd Ap = times(p);
    const double curvature = p.dot(Ap);
    if (!(curvature > 0.0)) {
      run.positive = false;
      break;
    }
    const double part = run.rho / curvature;
    y += part * p;
    r -= part * Ap;
    z = precondition(r);
    const double next = r.dot(z);
    p = z + next / run.rho * p;
    run.rho = next;
    ++run.iterations;
  }
  return run;
}

}  // namespace brainshift
