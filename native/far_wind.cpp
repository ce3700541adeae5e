// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// The wind of a crown apart from its anemometer (`core/wind/gusts/far_wind.py` has its equations).
#include <math.h>
#include <stddef.h>

#include "library.h"

namespace {

constexpr double PI = 3.14159265358979323846;

// Time over which the mean wind is taken [s]; least mean speed with which gusts travel [m/s]; run of
// the wind from one drawn sample to the next [m].
constexpr double AVERAGED = 600.0, SLOWEST = 0.5, SPACING = 0.25;

// Rows of the memory behind the low-passes.
enum { MEAN, VARIANCE, TOLD, RUN };

// Add the drawn wind at a run of the wind [m], over its deviations along the mean wind, across it
// and up, to that of each part (g, 3).
void add_drawn(const sway_farwind &by, double run, const double *mean, const double *variance,
               double *parts) {
  const double level = sqrt(mean[0] * mean[0] + mean[1] * mean[1]);
  const double c = level > 0.0 ? mean[0] / level : 1.0, s = level > 0.0 ? mean[1] / level : 0.0;
  const double along = sqrt(c * c * variance[0] + s * s * variance[1]);
  const double across = sqrt(s * s * variance[0] + c * c * variance[1]);
  const double up = sqrt(variance[2]);
  const double at = run / SPACING, first = floor(at), share = at - first;
  const int64_t row = static_cast<int64_t>(first) % by.samples;
  const float *low = by.rest + 3 * by.parts * row;
  const float *high = by.rest + 3 * by.parts * ((row + 1) % by.samples);
  for (int64_t i = 0; i < 3 * by.parts; i += 3) {
    double drawn[3];
    for (int axis = 0; axis < 3; axis++) {
      const double from = low[i + axis];
      drawn[axis] = from + share * (high[i + axis] - from);
    }
    parts[i] += along * c * drawn[0] - across * s * drawn[1];
    parts[i + 1] += along * s * drawn[0] + across * c * drawn[1];
    parts[i + 2] += up * drawn[2];
  }
}

}  // namespace

extern "C" void sway_push_farwind(const sway_farwind *pushed, double x, double y, double z,
                                  double dt, double *apart) {
  const sway_farwind &by = *pushed;
  const int64_t g = by.parts, k = by.stages;
  double *passed = by.memory, *own = passed + 3 * k;
  double *mean = own + 3 * MEAN, *variance = own + 3 * VARIANCE, *told = own + 3 * TOLD;
  double *run = own + 3 * RUN, *whole = by.whole;
  const double wind[] = {x, y, z};
  run[1] = fmin(run[1] + dt, fmax(AVERAGED, dt));
  const double share = dt / run[1];
  for (int axis = 0; axis < 3; axis++) {
    mean[axis] += share * (wind[axis] - mean[axis]);
    const double beyond = wind[axis] - mean[axis];
    variance[axis] += share * (beyond * beyond - variance[axis]);
  }
  const double level = sqrt(mean[0] * mean[0] + mean[1] * mean[1]), speed = fmax(level, SLOWEST);
  run[0] += speed * dt;
  for (int64_t j = 0; j < k; j++) {
    const double keep = fmax(-expm1(-speed * dt / by.length[j]), fmin(share, 1.0));
    for (int axis = 0; axis < 3; axis++)
      passed[3 * j + axis] += keep * (wind[axis] - passed[3 * j + axis]);
  }
  // Weights of the direction of the mean wind, between two of those that are known.
  const double *low = by.weights, *high = low;
  double between = 0.0;
  if (by.directions > 1) {
    const double turns = atan2(mean[1], mean[0]) / (2.0 * PI);
    const double at = (turns - floor(turns)) * static_cast<double>(by.directions);
    const int64_t first = static_cast<int64_t>(at);
    between = at - static_cast<double>(first);
    low += first % by.directions * g * k;
    high += (first + 1) % by.directions * g * k;
  }
  double expected[3] = {};
  for (int64_t i = 0; i < g; i++) {
    double sum[3] = {};
    for (int64_t j = 0; j < k; j++) {
      const double from = low[i * k + j], weight = from + between * (high[i * k + j] - from);
      for (int axis = 0; axis < 3; axis++)
        sum[axis] += weight * (passed[3 * j + axis] - mean[axis]);
    }
    for (int axis = 0; axis < 3; axis++) {
      expected[axis] += by.share[i] * sum[axis];
      apart[3 * i + axis] = sum[axis] + mean[axis];
    }
  }
  if (by.is_sample) {
    add_drawn(by, run[0], mean, variance, apart);
  } else {
    double lost[3];
    for (int axis = 0; axis < 3; axis++) {
      told[axis] += share * (expected[axis] * expected[axis] - told[axis]);
      lost[axis] = fmax(variance[axis] - told[axis], 0.0);
    }
    // All of u, half of v and w: 0.8 of u and v, as v has 0.64 of the variance of u.
    const double more = 0.8 * (lost[0] + lost[1]) + 0.5 * lost[2];
    for (int64_t i = 0; i < 3 * g; i += 3) {
      double *part = apart + i;
      const double square = part[0] * part[0] + part[1] * part[1] + part[2] * part[2];
      const double factor = sqrt(1.0 + more / fmax(square, more + 1e-9));
      for (int axis = 0; axis < 3; axis++) part[axis] *= factor;
    }
  }
  for (int axis = 0; axis < 3; axis++) {
    whole[axis] = 0.0;
    for (int64_t i = 0; i < g; i++) whole[axis] += by.share[i] * apart[3 * i + axis];
    for (int64_t i = 0; i < g; i++) apart[3 * i + axis] -= whole[axis];
  }
}
