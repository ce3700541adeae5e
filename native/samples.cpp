// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// The last samples of a motion sensor: checked as they are kept, and read at any time.
#include <math.h>
#include <string.h>

#include <algorithm>

#include "library.h"

namespace {

// Largest values of sensors: 32 g in [m/s^2]; 2,000 degrees per second, also in degrees.
constexpr double MOST[] = {320.0, 2500.0};

// Values above which a repeated number is the limit of a sensor; below, one that moves little.
constexpr double SATURATED[] = {15.0, 4.0};
constexpr int REPEATED = 3;

// Time by which a clock is set back, and longest time between samples that is bridged [s].
constexpr double CLOCK_BACK = 1.0, LONGEST_GAP = 0.25;
constexpr double SILENT_PERIODS = 4.0;

// Samples whose period is told, at most.
constexpr int64_t RECENT = 40;

// Share of a step within which a sample is of the time asked for.
constexpr double SAME_TIME = 0.01;

// Most votes by which quantities lead.
constexpr int64_t MOST_LEAD = 100;

// Time [s] and number of equal samples after which they are left out: a second of a dead sensor would
// throw the tree about.
constexpr double STILL = 0.15;
constexpr int64_t LEAST_STILL = 5;

// Change of a quantity that is a spike, over a running median of its changes or its least noise;
// spikes in a row that may be, and samples before the first.
constexpr double APART = 20.0;
constexpr int64_t SPIKES = 3, USUAL = 20;

// Bits of the quantities of a sample.
int64_t given_by(const double *sample) {
  int64_t bits = 0;
  for (int k = 0; k < 3; k++)
    if (isfinite(sample[3 * k] + sample[3 * k + 1] + sample[3 * k + 2])) bits |= 1 << k;
  return bits;
}

// Let a sample vote for its quantities (Boyer & Moore); whether most are for others.
bool outvotes(sway_ring &ring, int64_t given) {
  if (given == ring.given) {
    if (ring.lead < MOST_LEAD) ring.lead++;
    return false;
  }
  ring.lead -= given != 0;
  return ring.lead < 0;
}

// Whether the sensor has repeated its numbers for too long: it is dead, not at rest.
bool is_still(sway_ring &ring, double time, const double *sample) {
  if (memcmp(ring.offered, sample, sizeof ring.offered) != 0) {
    memcpy(ring.offered, sample, sizeof ring.offered);
    ring.moved_at = time;
    ring.still = 0;
    return false;
  }
  ring.moved_at = fmin(ring.moved_at, time);
  return ++ring.still >= LEAST_STILL && time - ring.moved_at >= STILL;
}

// Whether a sample is far from the one before, unless it is the last of several.
bool is_spike(sway_ring &ring, const double *sample) {
  bool is_far = false;
  for (int k = 0; k < 3; k++) {
    if (!(ring.given >> k & 1)) continue;
    double square = 0.0;
    for (int j = 3 * k; j < 3 * k + 3; j++) {
      const double way = sample[j] - ring.last[j];
      square += way * way;
    }
    const double change = sqrt(square);
    double usual = ring.changes[k] > 0.0 ? ring.changes[k] : change;
    if (usual < ring.noise[k]) usual = ring.noise[k];
    is_far |= change > APART * usual;
    // A running median: up or down by a twentieth.
    ring.changes[k] = (change > usual ? 1.05 : 0.95) * usual;
  }
  if (++ring.spikes <= 0) return false;
  if (is_far && ring.spikes <= SPIKES) return true;
  ring.spikes = 0;
  return false;
}

// Whether a number is repeated at the limit of the sensor.
bool is_saturated(sway_ring &ring, const double *sample) {
  bool found = false;
  for (int j = 0; j < 6; j++) {
    ring.same[j] = sample[j] == ring.before[j] ? ring.same[j] + 1 : 0;
    ring.before[j] = sample[j];
    found |= ring.same[j] >= REPEATED && fabs(sample[j]) > SATURATED[j / 3];
  }
  return found;
}

// Row of a sample, counted from the oldest.
int64_t row_of(const sway_ring &ring, int64_t from_oldest) {
  return int64_t(uint64_t(ring.first + from_oldest) % SWAY_RING);
}

void drop_oldest(sway_ring &ring) {
  ring.first = row_of(ring, 1);
  ring.count--;
}

// Keep a sample unless it is bad.
int keep(sway_ring &ring, double time, const double *sample, int64_t given) {
  if (!isfinite(time) || (given & ring.given) != ring.given) return SWAY_NOT_FINITE;
  for (int j = 0; j < 6; j++)
    if (fabs(sample[j]) > MOST[j / 3]) return SWAY_TOO_LARGE;
  int outcome = SWAY_KEPT;
  if (time <= ring.newest) {
    // One of the past is refused; several in a row, far back, are those of a new clock.
    if (time < ring.newest - CLOCK_BACK) ring.behind++;
    if (ring.behind < REPEATED) return SWAY_OUT_OF_ORDER;
    ring.count = ring.behind = 0;
    ring.newest = -INFINITY;
    outcome = SWAY_CLOCK_BACK;
  } else {
    ring.behind = 0;
    if (is_saturated(ring, sample)) return SWAY_SATURATED;
  }
  if (ring.count == SWAY_RING) drop_oldest(ring);
  const int64_t row = row_of(ring, ring.count);
  ring.time[row] = time;
  memcpy(ring.values[row], sample, sizeof ring.values[row]);
  ring.count++;
  ring.newest = time;
  return outcome;
}

}  // namespace

extern "C" {

int sway_keep_sample(sway_ring *kept, double time, const double *sample) {
  sway_ring &ring = *kept;
  const int64_t given = given_by(sample);
  if (outvotes(ring, given)) return SWAY_OTHERS;
  if (given && is_still(ring, time, sample)) {
    ring.is_followed = 0;
    return SWAY_STUCK;
  }
  if (ring.is_followed && is_spike(ring, sample)) return SWAY_SPIKE;
  const int outcome = keep(ring, time, sample, given);
  if (outcome > SWAY_CLOCK_BACK) return outcome;
  memcpy(ring.last, sample, sizeof ring.last);
  ring.is_followed = 1;
  return outcome;
}

void sway_ask_for(sway_ring *kept, int64_t given) {
  sway_ring &ring = *kept;
  ring.given = given;
  ring.lead = ring.count = ring.behind = ring.is_followed = 0;
  ring.spikes = -USUAL;
}

double sway_sample_period(const sway_ring *ring) {
  double steps[RECENT - 1];
  int64_t count = 0;
  double later = ring->newest;
  // Also of samples that were read. Times rise, but where the clock was set back.
  for (int64_t back = 2; back <= RECENT; back++) {
    const double stamp = ring->time[row_of(*ring, ring->count + SWAY_RING - back)];
    if (!(stamp < later)) break;
    steps[count++] = later - stamp;
    later = stamp;
  }
  if (!count) return NAN;
  std::nth_element(steps, steps + count / 2, steps + count);
  return steps[count / 2];
}

int sway_read_samples(sway_ring *kept, double time, double dt, double *sample) {
  sway_ring &ring = *kept;
  while (ring.count > 2 && ring.time[row_of(ring, 1)] < time - 0.5 * dt) drop_oldest(ring);
  int64_t within = 0, before = -1, after = -1;
  for (int j = 0; j < 9; j++) sample[j] = 0.0;
  for (int64_t k = 0; k < ring.count; k++) {
    const int64_t row = row_of(ring, k);
    const double stamp = ring.time[row];
    if (stamp > time && after < 0) after = row;
    if (stamp > time + 0.5 * dt) break;
    if (stamp > time - 0.5 * dt) {
      within++;
      for (int j = 0; j < 9; j++) sample[j] += ring.values[row][j];
    }
    if (stamp <= time) before = row;
  }
  if (within > 1) {
    for (int j = 0; j < 9; j++) sample[j] /= double(within);
    return 1;
  }
  if (before < 0) return 0;
  const double *from = ring.values[before];
  if (time - ring.time[before] < SAME_TIME * dt) {
    for (int j = 0; j < 9; j++) sample[j] = from[j];
    return 1;
  }
  if (after < 0) return 0;
  const double apart = ring.time[after] - ring.time[before];
  const bool is_gap = apart > LONGEST_GAP;
  if (is_gap && apart > SILENT_PERIODS * sway_sample_period(kept)) return 0;
  const double share = (time - ring.time[before]) / apart;
  for (int j = 0; j < 9; j++) sample[j] = from[j] + share * (ring.values[after][j] - from[j]);
  return 1;
}
}
