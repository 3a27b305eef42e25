#include "tissue/nodal_rotations.hpp"

#include <Eigen/LU>

#include "material/polar.hpp"

namespace brainshift {

std::vector<Mat3> nodal_rotations(const Mesh& mesh, const Points& u) {
  struct Mean {
    Mat3 gradient = Mat3::Zero();   // of the displacement, times volume
    double volume = 0.0;
  };
  std::vector<Mean> means(std::size_t(mesh.node_count()));
  const auto& tets = mesh.tets();
  for (Eigen::Index t = 0; t < tets.rows(); ++t) {
    Mat3 edges, moved;
    for (int k = 0; k < 3; ++k) {
      edges.col(k) = mesh.nodes().row(tets(t, k + 1)) - mesh.nodes().row(tets(t, 0));
      moved.col(k) = u.row(tets(t, k + 1)) - u.row(tets(t, 0));
    }
    const double volume = edges.determinant();
    const Mat3 gradient = volume * moved * edges.inverse();
    const auto add = [&](Index node) {
      means[std::size_t(node)].gradient += gradient;
      means[std::size_t(node)].volume += volume;
    };
    for (int k = 0; k < 4; ++k) add(tets(t, k));
    for (Eigen::Index k = 0; mesh.is_quadratic() && k < 6; ++k) add(mesh.edge_nodes()(t, k));
  }
  std::vector<Mat3> rotations;
  for (const Mean& mean : means) rotations.push_back(polar_decomposition(mean.gradient / mean.volume).R);
  return rotations;
}

}  // namespace brainshift
