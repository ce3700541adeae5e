// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "gusts.h"

#include <math.h>

namespace {

using namespace sway;

// Largest change of a delay in a step, over the length of the step.
constexpr double LARGEST_STRETCH = 0.5;

// Longest delay of a limb [s], slowest wind of its delays [m/s], and their averaging [s].
constexpr double LONGEST_DELAY = 8.0, SLOWEST = 2.0, AVERAGING = 30.0;

double at_least(double value, double least) { return value > least ? value : least; }
double at_most(double value, double most) { return value < most ? value : most; }

int64_t row_of(const History &history, int64_t from_oldest) {
  const int64_t last = count_of(*history.last, history.size - 1);
  const int64_t count = count_of(*history.count, history.size);
  return (last - count + 1 + from_oldest + history.size) % history.size;
}

// The integral of the wind until a time; before the history begins it is that of its first step.
void run_until(const History &history, double time, double out[3]) {
  int64_t low = 0, high = count_of(*history.count, history.size) - 1;
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    (history.run[4 * row_of(history, middle)] <= time ? low : high) = middle;
  }
  const double *a = history.run + 4 * row_of(history, low);
  const double *b = history.run + 4 * row_of(history, high);
  const double share = (time - a[0]) / (b[0] - a[0]);
  for (int axis = 0; axis < 3; axis++)
    out[axis] = a[1 + axis] + share * (b[1 + axis] - a[1 + axis]);
}

}  // namespace

namespace sway {

void remember(const History &history, double finest, const double wind[3], double dt) {
  const int64_t size = history.size;
  double *run = history.run;
  if (*history.count == 0.0) {
    for (int k = 0; k < 4; k++) run[k] = 0.0;
    *history.last = 0.0;
    *history.count = 1.0;
  }
  const int64_t last = count_of(*history.last, size - 1);
  const int64_t before = (last + size - 1) % size;
  const double step[] = {dt, wind[0] * dt, wind[1] * dt, wind[2] * dt};
  const bool is_joined = *history.count > 2.0 && run[4 * last] + dt - run[4 * before] <= finest;
  const int64_t head = is_joined ? last : (last + 1) % size;
  for (int k = 0; k < 4; k++) {
    if (head < last) {
      // Counted from zero again, so that the numbers do not grow with the days.
      const double origin = run[4 * last + k];
      for (int64_t i = 0; i < size; i++) run[4 * i + k] -= origin;
    }
    run[4 * head + k] = run[4 * last + k] + step[k];
  }
  if (is_joined) return;
  *history.last = static_cast<double>(head);
  *history.count = at_most(*history.count + 1.0, static_cast<double>(size));
}

void follow_mean(double mean[3], const double wind[3], double dt, double averaging) {
  mean[2] = at_most(mean[2] + dt, at_least(averaging, dt));
  const double weight = dt / mean[2];
  for (int axis = 0; axis < 2; axis++) mean[axis] += weight * (wind[axis] - mean[axis]);
}

void past_winds(const History &history, const double *wanted, double *delays, int64_t count,
                double longest, const double wind[3], double dt, double *out) {
  const double now = history.run[4 * count_of(*history.last, history.size - 1)];
  const double most = LARGEST_STRETCH * dt;
  for (int64_t i = 0; i < count; i++) {
    const double goal = at_most(at_least(wanted[i], 0.0), longest);
    // The first step has no delays before it.
    const double before = *history.count == 2.0 ? goal : delays[i];
    delays[i] = at_most(at_least(goal, before - most), before + most);
    if (before == 0.0 && delays[i] == 0.0) {
      for (int axis = 0; axis < 3; axis++) out[3 * i + axis] = wind[axis];
      continue;
    }
    const double begin = now - dt - before, end = now - delays[i];
    double from[3], to[3];
    run_until(history, begin, from);
    run_until(history, end, to);
    for (int axis = 0; axis < 3; axis++)
      out[3 * i + axis] = (to[axis] - from[axis]) / (end - begin);
  }
}

Crown crown_of(double *memory) {
  Crown crown;
  crown.history = {memory, memory + 1, memory + 2, HISTORY};
  crown.mean = memory + 2 + 4 * HISTORY;
  crown.wanted = crown.mean + 3;
  crown.delay = crown.wanted + DELAYS;
  crown.apart = crown.delay + DELAYS;
  return crown;
}

void push_crown(const Crown &crown, double spread, double coherence, const double wind[3],
                double dt) {
  if (spread <= 0.0) return;
  remember(crown.history, 2.0 * LONGEST_DELAY / (HISTORY - 4), wind, dt);
  follow_mean(crown.mean, wind, dt, AVERAGING);
  const double speed =
      at_least(sqrt(crown.mean[0] * crown.mean[0] + crown.mean[1] * crown.mean[1]), SLOWEST);
  const double longest = at_most(spread / speed, LONGEST_DELAY);
  for (int j = 0; j < DELAYS; j++) crown.wanted[j] = longest * j / (DELAYS - 1);
  past_winds(crown.history, crown.wanted, crown.delay, DELAYS, LONGEST_DELAY, wind, dt,
             crown.apart);
  for (int j = 0; j < DELAYS; j++)
    for (int axis = 0; axis < 3; axis++) {
      const double gust = (1.0 - coherence) * (crown.apart[3 * j + axis] - wind[axis]);
      // A history that was written may have any gusts.
      crown.apart[3 * j + axis] = fabs(gust) < STRONGEST ? gust : 0.0;
    }
}

}  // namespace sway

extern "C" {

void sway_past_winds(double *history, size_t size, double finest, const double *wanted,
                     double *delays, size_t count, double longest, const double *wind, double dt,
                     double *out) {
#ifndef SWAY_PAGE
  if (size == 0) return;  // no past is kept, and nothing is written
#endif
  const History own = {history, history + 1, history + 2, static_cast<int64_t>(size)};
  if (finest >= 0.0) remember(own, finest, wind, dt);
  past_winds(own, wanted, delays, static_cast<int64_t>(count), longest, wind, dt, out);
}

void sway_limb_winds(double *memory, double spread, double coherence, const double *wind,
                     double dt) {
  push_crown(crown_of(memory), spread, coherence, wind, dt);
}
}
