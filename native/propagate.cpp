// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// With h the length of a step, alpha = k2 h / 2 I, kappa = k1 h^2 / I and
// mu = -alpha +- sqrt(alpha^2 - kappa), the eigenvalues times h, all follows from divided
// differences of the exponential: s = e[mu1, mu2], p = e[0, mu1, mu2] and q = e[0, 0, mu1, mu2]
// (Higham 2008, Functions of Matrices, 10.7), each found by a method that loses no digits: the Taylor
// series of small pairs, differences of phi functions for real pairs far apart, closed forms for the
// rest. The phase of a lightly damped pair is a sum of two numbers, so that a thousand periods in one
// step are as exact as one (Dekker 1971, Numerische Mathematik 18, 224-242).
#include "propagate.h"

#include <math.h>
#include <string.h>

#include "library.h"

// A product and a sum are rounded each by itself, as their errors are computed.
#if defined(__clang__)
#pragma clang fp contract(off)
#else
#pragma GCC optimize("fp-contract=off")
#endif

namespace {

using namespace sway;

// Whether all forces are constant and steps short, as on a page: less is found then.
constexpr bool IS_HELD = ON_TABLES;

// A step of length 1 of unit inertia: q by q and v by v, and the differences of the exponential.
struct Differences {
  double g, d, s, p, q, p_minus_q;
};

constexpr double SMALL = 1.5;  // largest |mu| of the Taylor series
constexpr int TERMS = 27;  // of which it takes so many to 1e-17

// (e^z - 1) / z, and (e^z - 1 - z) / z^2.
double phi1(double z) { return z == 0.0 ? 1.0 : expm1(z) / z; }

double phi2(double z) {
  if (z < -1.0) return (phi1(z) - 1.0) / z;
  double sum = 0.0;
  for (int n = 19; n >= 2; n--) sum = (sum * z + 1.0) / n;
  return sum;
}

// A number as the sum of two, the second the rounding error of the first.
struct Sum {
  double high, low;
};

Sum exact_product(double a, double b) { return {a * b, fma(a, b, -(a * b))}; }

// delta = alpha^2 - kappa, and if it is not positive the phase sqrt(-delta).
struct Discriminant {
  double delta;
  Sum phase;
};

// By D = k2^2 - 4 I k1: delta is D (h / 2 I)^2, the phase sqrt(-D) h / 2 I. Where D is beyond the
// range of exact products, both are those of alpha and kappa.
Discriminant discriminant_of(double inertia, double damping, double stiffness, double h,
                             double alpha, double kappa) {
  const Sum damped = exact_product(damping, damping);
  const Sum stiff = exact_product(4.0 * inertia, stiffness);
  const double high = damped.high - stiff.high, taken = high - damped.high;
  const double low =
      (damped.high - (high - taken)) + (-stiff.high - taken) + damped.low - stiff.low;
  const double whole = high + low, scale = 0.5 * h / inertia;
  if (IS_HELD || !(fabs(whole) > 1e-250 && fabs(whole) < 1e250 && scale < 1e100)) {
    const double rough = alpha < 1e150 ? alpha * alpha - kappa : alpha * (alpha - kappa / alpha);
    return {rough, {rough < 0.0 ? sqrt(-rough) : 0.0, 0.0}};
  }
  if (whole > 0.0) return {whole * scale * scale, {0.0, 0.0}};
  const double root = sqrt(-whole), twice = 2.0 * inertia;
  const Sum square = exact_product(root, root);
  const double root_low = (((-high - square.high) - square.low) - low) / (2.0 * root);
  const Sum moved = exact_product(h, root);
  const double phase = moved.high / twice;
  const Sum back = exact_product(phase, twice);
  const double left = (moved.high - back.high) - back.low + (moved.low + h * root_low);
  return {whole * scale * scale, {phase, left / twice}};
}

// Sums of complete homogeneous polynomials of mu1, mu2 over factorials.
Differences by_series(double alpha, double kappa) {
  double before = 0.0, now = 1.0;  // of degree n - 1 and n
  double factor = 1.0;  // 1 / (n + 1)!
  Differences by = {};
  for (int n = 0; n < TERMS; n++) {
    const double term = factor * now;
    by.s += term;
    by.p += term / (n + 2);
    by.q += term / ((n + 2) * (n + 3));
    by.p_minus_q += term / (n + 3);
    const double next = -2.0 * alpha * now - kappa * before;
    before = now;
    now = next;
    factor /= n + 2;
  }
  by.g = 1.0 - kappa * by.p;
  by.d = by.g - 2.0 * alpha * by.s;
  return by;
}

// What follows from g, s and p where kappa is not small.
void close(double alpha, double kappa, Differences &by) {
  if (IS_HELD) return;
  by.q = (1.0 - by.s - 2.0 * alpha * by.p) / kappa;
  by.p_minus_q = (by.s + 2.0 * alpha * by.p - by.g) / kappa;
}

// A complex pair or a double one: a decaying oscillation.
Differences by_phase(double alpha, double kappa, const Sum &phase) {
  const double decay = exp(-alpha), turn = phase.high, low = phase.low;
  const double sine = sin(turn) + low * cos(turn), cosine = cos(turn) - low * sin(turn);
  const double half_sine = sin(0.5 * turn) + 0.5 * low * cos(0.5 * turn);
  Differences by;
  by.s = turn > 0.0 ? decay * sine / turn : decay;
  by.g = decay * cosine + alpha * by.s;
  by.d = decay * cosine - alpha * by.s;
  const double lost = 2.0 * decay * half_sine * half_sine - expm1(-alpha);  // 1 - decay cosine
  by.p = (lost - alpha * by.s) / kappa;
  close(alpha, kappa, by);
  return by;
}

// A real pair: differences of phi functions, or closed forms where it is close.
Differences by_decay(double alpha, double kappa, double sigma) {
  const double slow = -kappa / (alpha + sigma), fast = -(alpha + sigma), apart = 2.0 * sigma;
  Differences by;
  by.s = exp(slow) * (-expm1(-apart) / apart);
  by.g = exp(slow) - slow * by.s;
  if (3.0 * sigma < alpha) {
    by.d = exp(slow) + fast * by.s;
    by.p = (1.0 - by.g) / kappa;
    close(alpha, kappa, by);
    return by;
  }
  by.d = (slow * exp(slow) - fast * exp(fast)) / apart;
  by.p = (phi1(slow) - phi1(fast)) / apart;
  close(alpha, kappa, by);
  if (IS_HELD) return by;
  by.q = (phi2(slow) - phi2(fast)) / apart;
  if (slow >= -1.0) by.p_minus_q = by.p - by.q;
  return by;
}

Differences differences(double inertia, double damping, double stiffness, double h) {
  const double alpha = 0.5 * damping * h / inertia, kappa = stiffness * h * h / inertia;
  const Discriminant of = discriminant_of(inertia, damping, stiffness, h, alpha, kappa);
  const double sigma = of.delta > 0.0 ? sqrt(of.delta) : 0.0;  // or the phase is 0
  if (alpha + sigma + of.phase.high <= SMALL) return by_series(alpha, kappa);
  return of.delta > 0.0 ? by_decay(alpha, kappa, sigma) : by_phase(alpha, kappa, of.phase);
}

// Write the six coefficients of a coordinate, rows of `stride` numbers.
void fill(double stiffness, double damping, double h, double *c, int64_t stride) {
  const Differences by = differences(1.0, damping, stiffness, h);
  c[0] = by.g;
  c[stride] = h * by.s;
  c[2 * stride] = h * h * by.p;
  c[3 * stride] = -stiffness * h * by.s;
  c[4 * stride] = by.d;
  c[5 * stride] = h * by.s;
}

}  // namespace

namespace sway {

void fill_step(int64_t count, int64_t stride, const double *stiffness, const double *damping,
               double dt, const Step &step) {
  const double h = 0.5 * dt;
  for (int64_t i = 0; i < count; i++) {
    fill(stiffness[i], damping[i], dt, step.whole + i, stride);
    double *half = step.half + i;
    fill(stiffness[i], damping[i], h, half, stride);
    const double share = 1.0 / (1.0 + h * damping[i] + h * h * stiffness[i]);
    if (half[5 * stride] < h * share) {
      half[3 * stride] = -h * stiffness[i] * share;
      half[4 * stride] = share;
      half[5 * stride] = h * share;
      half[0] = 1.0 + h * half[3 * stride];
      half[stride] = h * half[4 * stride];
      half[2 * stride] = h * half[5 * stride];
    }
  }
}

}  // namespace sway

extern "C" {

void sway_steps(const double *stiffness, const double *damping, size_t count, double dt,
                double *whole, double *half) {
  const int64_t n = int64_t(count);
  fill_step(n, n, stiffness, damping, dt, {whole, half, dt});
}

int64_t sway_propagators(const double *inertia, const double *damping, const double *stiffness,
                         size_t count, double dt, double *out) {
  const double longest = fmax(dt, 1.0);
  int64_t refused = -1;
  for (size_t n = 0; n < count; n++) {
    const double i = inertia[n], k2 = damping[n], k1 = stiffness[n];
    const bool has_inertia =
        i > 0.0 && k2 * dt < 1e150 * i && fmax(k1 * dt, longest) * longest / i < 1e300;
    const bool is_damped = k2 > 0.0 && fmax(k1, 1.0) * longest / k2 < 1e300;
    double row[8] = {};
    if (has_inertia) {
      const Differences by = differences(i, k2, k1, dt);
      const double by_moment = dt / i;
      const double found[] = {by.g,
                              dt * by.s,
                              dt * by_moment * by.p_minus_q,
                              dt * by_moment * by.q,
                              -k1 * by_moment * by.s,
                              by.d,
                              by_moment * (by.s - by.p),
                              by_moment * by.p};
      memcpy(row, found, sizeof row);
    } else if (is_damped) {
      const double z = -k1 / k2 * dt, at_end = phi2(z), at_start = phi1(z) - at_end;
      row[0] = exp(z);
      row[2] = dt / k2 * at_start;
      row[3] = dt / k2 * at_end;
      row[4] = -k1 / k2 * row[0];
      row[6] = z * at_start / k2;
      row[7] = phi1(z) / k2;
    } else if (k1 > 0.0) {
      row[3] = 1.0 / k1;
      row[7] = 1.0 / (k1 * dt);
      row[6] = -row[7];
    } else {
      row[0] = 1.0;
      if (refused < 0) refused = int64_t(n);
    }
    memcpy(out + 8 * n, row, sizeof row);
  }
  return refused;
}
}
