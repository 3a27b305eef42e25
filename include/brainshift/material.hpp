// Constitutive laws and their parameters. docs/theory.md, section 2, has the formulas.
#pragma once

#include <string>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

enum class Law {
  linear,               // small strain, Hooke; exact only for small rotations
  corotational,         // mu |F-R|^2 + lambda/2 tr(R^T F - I)^2, exact tangent
  st_venant_kirchhoff,  // quadratic in Green's strain; limit point at stretch 1/sqrt(3)
  stable_neo_hookean,   // Smith, de Goes, Kim 2018, without the log term; defined at J <= 0
  log_neo_hookean       // mu/2 (I_C - 3) - mu ln J + lambda/2 ln^2 J; infinite at J <= 0
};

const char* to_string(Law law);
// Throws Error(invalid_argument) naming the word and the known ones.
Law law_from_name(const std::string& name);

// Where linear tets take the change of volume that lambda resists (docs/theory.md (22)): in each tet,
// which locks as Poisson's ratio nears 1/2, or averaged around each node, which does not.
enum class VolumeStrain { element, nodal };

class Material {
 public:
  // young: E > 0 (kPa). poisson: -1 < nu < 0.5. density >= 0 (kg/mm^3). All finite, else Error.
  Material(Law law, double young, double poisson, double density);

  Law law() const { return m_law; }
  double young() const { return m_young; }
  double poisson() const { return m_poisson; }
  double density() const { return m_density; }

  // Lame parameters and bulk modulus, kPa.
  double mu() const { return m_young / (2.0 * (1.0 + m_poisson)); }
  double lambda() const {
    return m_young * m_poisson / ((1.0 + m_poisson) * (1.0 - 2.0 * m_poisson));
  }
  double bulk() const { return m_young / (3.0 * (1.0 - 2.0 * m_poisson)); }

  // Response to a displacement gradient G = dU/dX (3 x 3), F = I + G. Where a law has no energy
  // (log_neo_hookean at det F <= 0) all answers are +infinity, so that no check can miss it.
  double energy(const Mat3& gradient) const;  // per rest volume, kPa
  Mat3 stress(const Mat3& gradient) const;    // first Piola-Kirchhoff P, kPa
  // dP/dF, 9 x 9, kPa; F and P as column-major vectors. `definite`: nearest positive semidefinite.
  Eigen::Matrix<double, 9, 9> tangent(const Mat3& gradient, bool definite = false) const;

 private:
  Law m_law;
  double m_young, m_poisson, m_density;
};

}  // namespace brainshift
