// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// How motion sensors correct a model: what they would measure by it, what they measure beyond it,
// and the steady filter of the difference (`core/observe/steady_filter.py` has its equations).
#include <math.h>
#include <string.h>

#include "library.h"

namespace {

// Share of the difference from the estimate by which the calm motion comes nearer per step.
constexpr double PACE = 0.15;

// Largest innovation that corrects, in its standard deviations.
constexpr double CLIPPED = 6.0;

// Rows of the model of a sensor: acceleration, its part by gravity, rate, rotation.
constexpr int ROWS = 12;

// to += factor * values, whose loop has no order: sums run over rows, not along them.
void add_row(int64_t count, double factor, const double *values, double *__restrict to) {
  for (int64_t i = 0; i < count; i++) to[i] += factor * values[i];
}

// Move states (rows, n), rows of which are written, by a law (rows, 3, n).
void move(int64_t n, const double *law, int rows, double *state) {
  for (int64_t i = 0; i < n; i++) {
    const double eta = state[i], rate = state[n + i], force = state[2 * n + i];
    for (int j = 0; j < rows; j++) {
      const double *by = law + 3 * j * n + i;
      state[j * n + i] = by[0] * eta + by[n] * rate + by[2 * n] * force;
    }
  }
}

double limited(double value, double most) { return fmin(fmax(value, -most), most); }

// Turn a vector of the frame of a sensor into that of the tree.
void turn(const double *matrix, double factor, const double *from, double *to) {
  for (int i = 0; i < 3; i++) {
    const double *row = matrix + 3 * i;
    to[i] = factor * (row[0] * from[0] + row[1] * from[1] + row[2] * from[2]);
  }
}

}  // namespace

extern "C" {

void sway_sense(const sway_sensed *sensed, const double *eta, const double *rate,
                const double *force, size_t slot) {
  const int64_t m = sensed->coordinates, n = sensed->corrected, r = sensed->rows;
  const double *const state[] = {eta, rate, force};
  double *found = sensed->sensed + slot * r;
  for (int64_t k = 0; k < r; k++) found[k] = 0.0;
  for (int j = 0; j < 3; j++)
    for (int64_t i = 0; i < m; i++)
      add_row(r, state[j][i], sensed->by_state + (j * m + i) * r, found);
  double *still = sensed->still + slot * n;
  for (int64_t i = 0; i < n; i++) still[i] = sensed->air_damping[i] * rate[i] + force[i];
}

int sway_read_sensor(const sway_sensor *sensor, double time, double dt, const double *computed,
                     size_t row, double *beyond) {
  double sample[9];
  if (!sway_read_samples(sensor->ring, time, dt, sample)) return 0;
  memcpy(sensor->kept + 9 * row, sample, sizeof sample);
  memcpy(sensor->kept_computed + ROWS * row, computed, ROWS * sizeof(double));
  const double *mounting = sensor->mounting, *bias = mounting + 12;
  double *moved = sensor->moved;
  turn(mounting, mounting[9], sample, moved);
  turn(mounting, mounting[10], sample + 3, moved + 3);
  turn(mounting, 1.0, sample + 6, moved + 6);
  moved[2] -= mounting[11];
  for (int i = 0; i < 9; i++) beyond[i] = moved[i] - bias[i];
  for (int i = 0; i < 3; i++) {
    // The part by tilted gravity is felt with gravity only.
    const double tilted = mounting[11] > 0.0 ? computed[3 + i] : 0.0;
    beyond[i] -= computed[i] + tilted;
    beyond[3 + i] -= computed[6 + i];
    beyond[6 + i] -= computed[9 + i];
  }
  return 1;
}

void sway_correct(const sway_filter *filter, const double *beyond, const uint8_t *is_known,
                  size_t steps) {
  const int64_t n = filter->coordinates, p = filter->measurements;
  double *state = filter->state, *calm = filter->calm;
  for (size_t step = 0; step < steps; step++) {
    move(n, filter->law, 3, state);
    move(n, filter->law, 3, calm);
  }
  double *last = filter->innovations + (filter->lag - 1) * p;
  memmove(filter->innovations, filter->innovations + p,
          static_cast<size_t>(filter->lag - 1) * p * sizeof(double));
  for (int64_t k = 0; k < p; k++) last[k] = 0.0;
  for (int64_t i = 0; i < 3 * n; i++) add_row(p, state[i], filter->sensed + i * p, last);
  for (int64_t k = 0; k < p / 3; k++) filter->sizes[k] = 0.0;
  for (int64_t k = 0; k < p; k++) {
    const int64_t row = filter->row[k];
    const double innovation = is_known[row / 9] ? beyond[row] - last[k] : 0.0;
    const double deviation = filter->deviation[k], size = innovation / deviation;
    last[k] = limited(innovation, CLIPPED * deviation);
    filter->sizes[k / 3] += size * size / 3.0;
    add_row(3 * n, last[k], filter->gain + 3 * n * k, state);
  }
  for (int64_t i = 0; i < 3 * n; i++) calm[i] += PACE * (state[i] - calm[i]);
}

void sway_carry(const sway_correction *correction, const double *ahead, const double *calm,
                double share, const double *eta, const double *rate) {
  const int64_t n = correction->coordinates;
  double *trust = correction->trust, *moved = correction->moved, *moving = moved + n;
  double whole = 0.0, own = 0.0;
  for (int64_t i = 0; i < n; i++) {
    trust[i] += share * (correction->wanted[i] - trust[i]);
    const double *by = ahead + i;
    moved[i] = trust[i] * (by[0] * calm[i] + by[n] * calm[n + i] + by[2 * n] * calm[2 * n + i]);
    by += 3 * n;
    moving[i] = trust[i] * (by[0] * calm[i] + by[n] * calm[n + i] + by[2 * n] * calm[2 * n + i]);
    const double stiffness = correction->stiffness[i], x = eta[i], v = rate[i];
    const double at = x + moved[i], going = v + moving[i];
    whole += stiffness * at * at + going * going;
    own += stiffness * x * x + v * v;
  }
  correction->energies[0] = whole;
  correction->energies[1] = own;
}

void sway_drag(const sway_dragged *dragged, const double *correction, size_t steps,
               double *added) {
  const int64_t m = dragged->coordinates, n = dragged->corrected;
  double *state = dragged->state, *force = state + 2 * m;
  for (int64_t i = 0; i < m; i++) force[i] = 0.0;
  for (int64_t j = 0; j < n; j++) add_row(m, correction[n + j], dragged->drag + j * m, force);
  for (int64_t j = 0; j < n; j++) force[j] *= 1.0 - dragged->trust[j];
  for (size_t step = 0; step < steps; step++) move(m, dragged->law, 2, state);
  memcpy(added, state, static_cast<size_t>(2 * m) * sizeof(double));
  for (int64_t j = 0; j < n; j++) {
    added[j] += correction[j];
    added[m + j] += correction[n + j];
  }
}
}
