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

// The history in memory: two numbers and rows.
History history_of(double *memory, int64_t size) {
  return {memory, memory + 1, reinterpret_cast<FourAt *>(memory + 2), size};
}

int64_t row_of(const History &history, int64_t from_oldest) {
  const int64_t last = count_of(*history.last, history.size - 1);
  const int64_t count = count_of(*history.count, history.size);
  return (last - count + 1 + from_oldest + history.size) % history.size;
}

// The integral of the wind until a time, as rows have it; before the history begins it is that of its
// first step.
Four run_until(const History &history, double time) {
  int64_t low = 0, high = count_of(*history.count, history.size) - 1;
  while (high - low > 1) {
    const int64_t middle = (low + high) / 2;
    (history.run[row_of(history, middle)][0] <= time ? low : high) = middle;
  }
  const Four from = history.run[row_of(history, low)], to = history.run[row_of(history, high)];
  return from + (time - from[0]) / (to[0] - from[0]) * (to - from);
}

}  // namespace

namespace sway {

void remember(const History &history, double finest, const double wind[3], double dt) {
  const int64_t size = history.size;
  FourAt *run = history.run;
  if (*history.count == 0.0) {
    run[0] = Four{};
    *history.last = 0.0;
    *history.count = 1.0;
  }
  const int64_t last = count_of(*history.last, size - 1);
  const int64_t before = (last + size - 1) % size;
  const bool is_joined = *history.count > 2.0 && run[last][0] + dt - run[before][0] <= finest;
  const int64_t head = is_joined ? last : (last + 1) % size;
  if (head < last) {
    // Counted from zero again, so that the numbers do not grow with the days.
    const Four origin = run[last];
    for (int64_t i = 0; i < size; i++) run[i] -= origin;
  }
  run[head] = run[last] + dt * Four{1.0, wind[0], wind[1], wind[2]};
  if (is_joined) return;
  *history.last = double(head);
  *history.count = least(*history.count + 1.0, double(size));
}

void past_winds(const History &history, const double *wanted, double *delays, int64_t count,
                double longest, const double wind[3], double dt, double *out) {
  const double now = history.run[count_of(*history.last, history.size - 1)][0];
  const double stretch = LARGEST_STRETCH * dt;
  for (int64_t i = 0; i < count; i++) {
    const double goal = least(most(wanted[i], 0.0), longest);
    // The first step has no delays before it.
    const double before = *history.count == 2.0 ? goal : delays[i];
    delays[i] = least(most(goal, before - stretch), before + stretch);
    Four mean = {0.0, wind[0], wind[1], wind[2]};
    if (before != 0.0 || delays[i] != 0.0) {
      const double begin = now - dt - before, end = now - delays[i];
      mean = (run_until(history, end) - run_until(history, begin)) / (end - begin);
    }
    for (int axis = 0; axis < 3; axis++) out[3 * i + axis] = mean[1 + axis];
  }
}

void push_crown(Crown &crown, double spread, double coherence, const double wind[3], double dt) {
  if (spread <= 0.0) return;
  const History history = history_of(&crown.last, HISTORY);
  remember(history, 2.0 * LONGEST_DELAY / (HISTORY - 4), wind, dt);
  double *mean = crown.mean;
  crown.averaged = least(crown.averaged + dt, most(AVERAGING, dt));
  for (int axis = 0; axis < 2; axis++)
    mean[axis] += dt / crown.averaged * (wind[axis] - mean[axis]);
  const double speed = most(sqrt(mean[0] * mean[0] + mean[1] * mean[1]), SLOWEST);
  const double longest = least(spread / speed, LONGEST_DELAY);
  for (int j = 0; j < DELAYS; j++) crown.wanted[j] = longest * j / (DELAYS - 1);
  past_winds(history, crown.wanted, crown.delay, DELAYS, LONGEST_DELAY, wind, dt, crown.apart);
  for (int j = 0; j < 3 * DELAYS; j++) {
    const double gust = (1.0 - coherence) * (crown.apart[j] - wind[j % 3]);
    // A history that was written may have any gusts.
    crown.apart[j] = fabs(gust) < STRONGEST ? gust : 0.0;
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
  const History own = history_of(history, int64_t(size));
  if (finest >= 0.0) remember(own, finest, wind, dt);
  past_winds(own, wanted, delays, int64_t(count), longest, wind, dt, out);
}

void sway_limb_winds(double *memory, double spread, double coherence, const double *wind,
                     double dt) {
  push_crown(crown_of(memory), spread, coherence, wind, dt);
}
}
