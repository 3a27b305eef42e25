// A supernodal Cholesky factor in single precision, in the place of the double one: a solve waits for memory, and
// reads half as much.
#pragma once

#include <vector>

#include <cholmod.h>
#include <Eigen/Core>

namespace brainshift {

class SingleFactor {
 public:
  // Overwrites the entries of the factor, whose own solves are spoilt until it is factored again; it must outlive
  // this. False: some entry has no value in single precision, and the factor is as it was.
  bool take(cholmod_factor& factor);
  bool holds() const { return m_factor != nullptr; }
  void clear() { m_factor = nullptr; }
  // x := (P^T L L^T P)^-1 x, to single precision.
  void solve(Eigen::Ref<Eigen::VectorXd> x);

 private:
  void forward();
  void backward();

  const cholmod_factor* m_factor = nullptr;
  std::vector<float> m_x, m_below;   // permuted; entries of x on the rows below a supernode
};

}  // namespace brainshift
