// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// With h the length of a step, alpha = damping h / 2, kappa = stiffness h^2 and
// mu = -alpha +- sqrt(alpha^2 - kappa), the eigenvalues times h, all follows from divided
// differences of the exponential: s = e[mu1, mu2] and p = e[0, mu1, mu2] (Higham 2008, Functions of
// Matrices, 10.7), each found by a method that loses no digits.
#include "propagate.h"

#include <math.h>

namespace {

using namespace sway;

// Coordinate by coordinate, by rate, by force; then the rate by the same, of a step of length 1.
struct Differences {
  double g, d;  // diagonal of the exponential: q by q, v by v
  double s, p;
};

constexpr double SMALL = 1.5;  // largest |mu| of the Taylor series
constexpr int TERMS = 27;  // of which it takes so many to 1e-17

// The differences are sums of complete homogeneous polynomials of mu1, mu2 over factorials.
Differences by_series(double alpha, double kappa) {
  double before = 0.0, now = 1.0;  // of degree n - 1 and n
  double factor = 1.0;  // 1 / (n + 1)!
  double s = 0.0, p = 0.0;
  for (int n = 0; n < TERMS; n++) {
    s += now * factor;
    factor /= n + 2;
    p += now * factor;
    const double next = -2.0 * alpha * now - kappa * before;
    before = now;
    now = next;
  }
  const double g = 1.0 - kappa * p;
  return {g, g - 2.0 * alpha * s, s, p};
}

double phi1(double z) { return z == 0.0 ? 1.0 : expm1(z) / z; }

Differences differences(double alpha, double kappa) {
  const double delta = alpha * alpha - kappa;
  const double sigma = sqrt(fabs(delta));
  if (alpha + sigma <= SMALL) return by_series(alpha, kappa);
  if (delta <= 0.0) {
    const double decay = exp(-alpha);
    const double sinc = sigma > 0.0 ? sin(sigma) / sigma : 1.0;
    const double s = decay * sinc;
    const double g = decay * cos(sigma) + alpha * s;
    return {g, decay * cos(sigma) - alpha * s, s, (1.0 - g) / kappa};
  }
  const double slow = -kappa / (alpha + sigma), fast = -(alpha + sigma), apart = 2.0 * sigma;
  const double s = exp(slow) * (-expm1(-apart) / apart);
  const double g = exp(slow) - slow * s;
  const bool is_close = 3.0 * sigma < alpha;
  const double d = is_close ? exp(slow) + fast * s : (slow * exp(slow) - fast * exp(fast)) / apart;
  const double p = is_close ? (1.0 - g) / kappa : (phi1(slow) - phi1(fast)) / apart;
  return {g, d, s, p};
}

// Write the six coefficients of a coordinate, rows of `padded` numbers.
void fill(double stiffness, double damping, double h, double *c, int64_t padded) {
  const double kappa = stiffness * h * h;
  const Differences by = differences(0.5 * damping * h, kappa);
  c[0] = by.g;
  c[padded] = h * by.s;
  c[2 * padded] = h * h * by.p;
  c[3 * padded] = -stiffness * h * by.s;
  c[4 * padded] = by.d;
  c[5 * padded] = h * by.s;
}

}  // namespace

namespace sway {

void fill_step(const sway_model &model, const double *stiffness, const double *damping, double dt,
               const Step &step) {
  const int64_t M = model.padded;
  const double h = 0.5 * dt;
  for (int64_t i = 0; i < model.sizes.coordinates; i++) {
    fill(stiffness[i], damping[i], dt, step.whole + i, M);
    double *half = step.half + i;
    fill(stiffness[i], damping[i], h, half, M);
    const double share = 1.0 / (1.0 + h * damping[i] + h * h * stiffness[i]);
    if (half[5 * M] < h * share) {
      half[3 * M] = -h * stiffness[i] * share;
      half[4 * M] = share;
      half[5 * M] = h * share;
      half[0] = 1.0 + h * half[3 * M];
      half[M] = h * half[4 * M];
      half[2 * M] = h * half[5 * M];
    }
  }
}

}  // namespace sway
