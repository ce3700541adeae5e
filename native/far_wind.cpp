// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// The wind of a crown apart from its anemometer (`core/wind/gusts/far_wind.py` has its equations).
#include <math.h>

#include "library.h"
#include "turn.h"

namespace {

typedef Vector<double> V3;

constexpr double TURN = 6.28318530717958647692;

// Time over which the mean wind is taken [s]; least mean speed with which gusts travel [m/s]; run of
// the wind from one drawn sample to the next [m].
constexpr double AVERAGED = 600.0, SLOWEST = 0.5, SPACING = 0.25;

// The memory behind the low-passes.
struct Known {
  V3 mean, variance;
  V3 told;      // mean square of what is expected of the crown
  double run;   // of the wind [m]
  double time;  // that the mean spans [s]
};

V3 squares(const V3 &v) { return {v.x * v.x, v.y * v.y, v.z * v.z}; }

double level(const V3 &wind) { return sqrt(wind.x * wind.x + wind.y * wind.y); }

// Add the drawn wind at the run of the wind, over its deviations along the mean wind, across it and
// up, to that of each part (g).
void add_drawn(const sway_farwind &by, const Known &known, V3 *parts) {
  const V3 &variance = known.variance;
  const double speed = level(known.mean);
  const double c = speed > 0.0 ? known.mean.x / speed : 1.0;
  const double s = speed > 0.0 ? known.mean.y / speed : 0.0;
  const double along = sqrt(c * c * variance.x + s * s * variance.y);
  const double across = sqrt(s * s * variance.x + c * c * variance.y);
  const double up = sqrt(variance.z);
  const double at = known.run / SPACING, first = floor(at), share = at - first;
  const int64_t row = int64_t(first) % by.samples;
  const float *low = by.rest + 3 * by.parts * row;
  const float *high = by.rest + 3 * by.parts * ((row + 1) % by.samples);
  for (int64_t i = 0; i < by.parts; i++) {
    double drawn[3];
    for (int64_t axis = 0; axis < 3; axis++) {
      const double from = low[3 * i + axis];
      drawn[axis] = from + share * (high[3 * i + axis] - from);
    }
    parts[i] += V3{along * c * drawn[0] - across * s * drawn[1],
                   along * s * drawn[0] + across * c * drawn[1], up * drawn[2]};
  }
}

// Make all winds of parts stronger, so that they have the energy which is lost by their mean.
void add_lost(const sway_farwind &by, const V3 &lost, V3 *parts) {
  // All of u, half of v and w: 0.8 of u and v, as v has 0.64 of the variance of u.
  const double more = 0.8 * (fmax(lost.x, 0.0) + fmax(lost.y, 0.0)) + 0.5 * fmax(lost.z, 0.0);
  for (int64_t i = 0; i < by.parts; i++)
    parts[i] = sqrt(1.0 + more / fmax(dot(parts[i], parts[i]), more + 1e-9)) * parts[i];
}

}  // namespace

extern "C" void sway_push_farwind(const sway_farwind *pushed, double x, double y, double z,
                                  double dt, double *apart) {
  const sway_farwind &by = *pushed;
  const int64_t g = by.parts, k = by.stages;
  V3 *parts = reinterpret_cast<V3 *>(apart), *passed = reinterpret_cast<V3 *>(by.memory);
  Known &known = *reinterpret_cast<Known *>(passed + k);
  const V3 &mean = known.mean, wind = {x, y, z};
  known.time = fmin(known.time + dt, fmax(AVERAGED, dt));
  const double share = dt / known.time;
  known.mean = mean + share * (wind - mean);
  known.variance += share * (squares(wind - mean) - known.variance);
  const double speed = fmax(level(mean), SLOWEST);
  known.run += speed * dt;
  for (int64_t j = 0; j < k; j++) {
    const double keep = fmax(-expm1(-speed * dt / by.length[j]), fmin(share, 1.0));
    passed[j] += keep * (wind - passed[j]);
  }
  // Weights of the direction of the mean wind, between two of those that are known.
  const double turns = atan2(mean.y, mean.x) / TURN;
  const double at = (turns - floor(turns)) * double(by.directions);
  const int64_t first = int64_t(at);
  const double between = at - double(first);
  const double *low = by.weights + first % by.directions * g * k;
  const double *high = by.weights + (first + 1) % by.directions * g * k;
  V3 expected = {};
  for (int64_t i = 0; i < g; i++) {
    V3 sum = {};
    for (int64_t j = 0; j < k; j++) {
      const double from = low[i * k + j], weight = from + between * (high[i * k + j] - from);
      sum += weight * (passed[j] - mean);
    }
    expected += by.share[i] * sum;
    parts[i] = sum + mean;
  }
  if (by.is_sample) {
    add_drawn(by, known, parts);
  } else {
    known.told += share * (squares(expected) - known.told);
    add_lost(by, known.variance - known.told, parts);
  }
  V3 whole = {};
  for (int64_t i = 0; i < g; i++) whole += by.share[i] * parts[i];
  for (int64_t i = 0; i < g; i++) parts[i] = parts[i] - whole;
  write(by.whole, whole);
}
