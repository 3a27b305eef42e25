#include <cstdlib>

#include "brainshift/error.hpp"
#include "brainshift/stepper.hpp"
#include "robustness/fuzz/numbers.hpp"
#include "robustness/fuzz/targets.hpp"

namespace brainshift::test {

// Up to seven nodes and six tets, a law, supports and one solve: balance with a certificate, a status
// with a sentence, or an Error.
void fuzz_mesh(const std::uint8_t* data, std::size_t size) {
  Numbers numbers(data, size);
  const int node_count = 4 + numbers.byte() % 4, tet_count = 1 + numbers.byte() % 6;
  const Law law = Law(numbers.byte() % 5);
  Points nodes(node_count, 3);
  Tets tets(tet_count, 4);
  for (Eigen::Index i = 0; i < tets.size(); ++i) tets.data()[i] = Index(numbers.byte() % 9) - 1;
  for (Eigen::Index i = 0; i < nodes.size(); ++i) nodes.data()[i] = 4.0 * numbers.number();
  try {
    MeshOptions turn;
    turn.orient = numbers.byte() % 2 == 0;
    Scene scene{Mesh(nodes, tets, {}, turn),
                {{0, Material(law, numbers.number(), numbers.number(), 1e-6)}},
                {numbers.number() * 1e3, numbers.number() * 1e3, numbers.number() * 1e3}};
    scene.balanced_reference = false;
    scene.constraints.fix("held", {0, 1, Index(numbers.byte() % 8)},
                          {true, true, numbers.byte() % 2 == 0});
    scene.constraints.support("springs", {Index(numbers.byte() % 8)},
                              Eigen::VectorXd::Constant(1, numbers.number()));
    StepperOptions options;
    options.max_iterations = 8;
    options.smallest_load_step = 0.25;
    Stepper stepper(scene, options);
    const SolveReport report =
        numbers.byte() % 2 == 0 ? stepper.solve_static() : stepper.step(numbers.number());
    if (!stepper.displacement().allFinite()) std::abort();
    if (report.converged()) {
      if (!(report.residual <= options.residual_tolerance)) std::abort();
      if (!(report.smallest_jacobian > 0.0)) std::abort();
    } else if (report.message.empty() || !stepper.displacement().isZero(0.0)) {
      std::abort();
    }
  } catch (const Error&) {
  }
}

}  // namespace brainshift::test
