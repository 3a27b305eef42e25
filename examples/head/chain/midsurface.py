"""The mid-surface x = x_m(y, z): a curved sheet through the interhemispheric fissure, a polynomial of
degree 4 in y and z. A plane may be 5 mm wrong where the falx bends in the occipital region."""
import numpy as np

POWERS = [(i, j) for i in range(5) for j in range(5 - i)]  # x_m = sum c_k (y/100)^i (z/100)^j


def terms(y, z):
    u, v = np.asarray(y, float) / 100, np.asarray(z, float) / 100
    return np.stack([u**i * v**j for i, j in POWERS], axis=-1)


def evaluate(coefficients, y, z):
    """x_m in mm, head frame."""
    return terms(y, z) @ coefficients


def robust(points):
    """Coefficients through points (n, 3) and the residuals (mm): least squares reweighted by Cauchy's
    function at 1 mm, so that what lies off the fissure hardly counts."""
    matrix, weight = terms(points[:, 1], points[:, 2]), np.ones(len(points))
    for _ in range(20):
        root = np.sqrt(weight)[:, None]
        coefficients = np.linalg.lstsq(matrix * root, points[:, 0] * root[:, 0], rcond=None)[0]
        residual = points[:, 0] - matrix @ coefficients
        weight = 1 / (1 + residual**2)
    return coefficients, residual


def rounded(coefficients, residual):
    """Coefficients to 1e-6 (1e-6 mm at y = z = 100: the mesh shall not hang on the last bits of a
    LAPACK), and the rms (mm) of what lies within 3 mm."""
    close = np.abs(residual) < 3
    return np.round(coefficients, 6), float(np.sqrt(np.mean(residual[close]**2)))
