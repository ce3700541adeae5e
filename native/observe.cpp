// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// How motion sensors correct a model: what they would measure by it, what they measure beyond it,
// and the steady filter of the difference (`twin/steady_filter.py` has its equations).
// Nothing is read or written beyond the arrays whose sizes the structures state.
#include <math.h>
#include <string.h>

#include "library.h"
#include "turn.h"

namespace {

// Share of the difference from the estimate by which the calm motion comes nearer per step.
constexpr double PACE = 0.15;

// Largest innovation that corrects, in its standard deviations.
constexpr double CLIPPED = 6.0;

// Rows of the model of a sensor: acceleration, its part by gravity, rate, rotation.
constexpr int ROWS = 12;

constexpr double GRAVITY = 9.80665;

// Time without a sample after which a sensor is silent: longer than networks delay one [s].
constexpr double SILENT = 1.0;

// How late sensors are. When a sample comes, the step that is just made tells how old what was known
// of the sensor was at its worst; the share by which such a lag above or below the known one is
// followed, so that a stall now and then counts little. Steps by which sensors may be read later
// than needed before they are read sooner.
constexpr double UP = 0.2, DOWN = 0.005;
constexpr int64_t SPARE = 2;

// Time over which the squares of innovations are averaged [s], their mean above which a sensor
// disagrees and below which it agrees, and the time after which it is trusted again [s].
constexpr double AVERAGED = 2.0, DISAGREES = 16.0, AGREES = 4.0, TRUSTED_AGAIN = 5.0;

// These are over what is usual of this sensor, found while it is in use (Mehra 1972, IEEE Transactions
// on Automatic Control 17, 693-698): a limb has more modes than the filter, and its rate is mostly
// theirs. A sensor begins with the most that right ones have, and is followed up and down with time
// constants [s].
constexpr double MOST_USUAL = 16.0, USUAL_UP = 160.0, USUAL_DOWN = 5.0;

// Squares of innovations over the usual ones, and for how long in a row [s], as of a sensor that has
// fallen off its belt, and of no sway of a twig: on one of many modes their mean tells it seconds later.
constexpr double THROWN = 100.0, THROWN_FOR = 0.1;

// Largest square that counts: one spike in a hundred samples is no reason to disagree, and after a
// knock a sensor is to be followed again in half a minute.
constexpr double LARGEST = 400.0;

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

// Move a filter by a step, and write the measurements that it expects then.
void expect(const sway_filter &filter, double *expected) {
  const int64_t n = filter.coordinates, p = filter.measurements;
  move(n, filter.law, 3, filter.state);
  for (int64_t k = 0; k < p; k++) expected[k] = 0.0;
  for (int64_t i = 0; i < 3 * n; i++) add_row(p, filter.state[i], filter.sensed + i * p, expected);
}

double limited(double value, double most) { return fmin(fmax(value, -most), most); }

// Note the newest sample of a sensor at the time of a step; whether there is another.
bool note_lag(sway_sensor &sensor, double time) {
  const double newest = sensor.ring->newest, before = sensor.heard;
  if (newest == before) return false;
  sensor.heard = newest;
  sensor.came = time;
  const double lag = time - sensor.dt - before;  // at the last step without it
  if (newest < before || lag > SWAY_LATEST * sensor.dt) return true;
  const double missing = fmax(lag, 0.0) - sensor.lag;
  sensor.lag += (missing > 0.0 ? UP : DOWN) * missing;
  return true;
}

// Find by how many steps sensors are read late, so that the samples of those that are heard are
// there, at the time of a step.
void follow_lags(sway_readings &readings, double time) {
  bool is_new = false, is_heard = false;
  double most = 0.0;  // steps
  for (int64_t i = 0; i < readings.sensors; i++) {
    sway_sensor &sensor = *readings.sensor[i];
    if (sensor.in_use || sensor.is_awaited) is_new |= note_lag(sensor, time);
    if (time - sensor.came >= SILENT) continue;
    most = fmax(most, sensor.lag / sensor.dt);
    is_heard = true;
  }
  if (!is_new) return;
  const int64_t needed = int64_t(fmin(ceil(most - 0.01), SWAY_LATEST));
  if (needed > readings.late || (is_heard && needed < readings.late - SPARE))
    readings.late = needed;
}

// What a sensor of some shapes (6, m) would measure. The specific force that a sensor turned by theta
// feels beyond gravity is a + g z x theta in the frame of the tree.
void sense(const sway_readings &by, const double *shapes, double *found) {
  const int64_t m = by.coordinates;
  for (int axis = 0; axis < 3; axis++) {
    const double *moved = shapes + axis * m, *turned = moved + 3 * m;
    double acceleration = 0.0, rate = 0.0, rotation = 0.0;
    for (int64_t i = 0; i < m; i++) {
      const double pull = by.stiffness[i] * by.eta[i] + by.damping[i] * by.rate[i];
      acceleration += moved[i] * (by.force[i] - pull);
      rate += turned[i] * by.rate[i];
      rotation += turned[i] * by.eta[i];
    }
    found[axis] = acceleration;
    found[6 + axis] = rate;
    found[9 + axis] = rotation;
  }
  found[3] = -GRAVITY * found[10];
  found[4] = GRAVITY * found[9];
  found[5] = 0.0;
}

// Note that there is no sample about a time.
void miss(sway_sensor &sensor, double time) {
  const double newest = sensor.ring->newest;
  sensor.absent += sensor.dt;
  sensor.unheard = newest == sensor.newest ? sensor.unheard + sensor.dt : 0.0;
  sensor.newest = newest;
  sensor.apart = newest - time;
  if (sensor.absent <= SILENT) return;
  sensor.silences += sensor.in_use;
  sensor.in_use = 0;
}

// Read a sensor about a time, keep its sample and the rows of the model, and write what the sample
// has beyond the model. Whether there is one, and the mounting is known.
bool read_sensor(sway_sensor &sensor, double time, const double *computed, double *beyond) {
  double sample[9];
  if (!sway_read_samples(sensor.ring, time, sensor.dt, sample)) {
    miss(sensor, time);
    return false;
  }
  sensor.absent = 0.0;
  const int64_t row = (sensor.count++ % sensor.rows + sensor.rows) % sensor.rows;
  memcpy(sensor.kept + 9 * row, sample, sizeof sample);
  memcpy(sensor.computed + ROWS * row, computed, ROWS * sizeof(double));
  const double *mounting = sensor.mounting, *bias = mounting + 12;
  double *moved = sensor.moved;
  const double factors[] = {mounting[9], mounting[10], 1.0};
  for (int k = 0; k < 9; k += 3)
    write(moved + k, factors[k / 3] * (read_matrix(mounting) * read(sample + k)));
  moved[2] -= mounting[11];
  for (int i = 0; i < 9; i++) beyond[i] = moved[i] - bias[i] - computed[3 + i];
  for (int i = 0; i < 3; i++) {
    // The part by tilted gravity is felt with gravity only.
    const double unfelt = mounting[11] > 0.0 ? 0.0 : computed[3 + i];
    beyond[i] += unfelt - computed[i];
  }
  return sensor.is_mounted;
}

// Add the last sample of a sensor to its series, with forces (n) at its time.
void add_to_series(const sway_sensor &sensor, const double *forces, int64_t n) {
  sway_series *series = sensor.series;
  if (!series) return;
  double *row = series->rows + series->filled++ % (SWAY_HALVES * series->half) * (n + 4);
  memcpy(row, sensor.moved + series->first, 2 * sizeof(double));
  memcpy(row + 2, forces, size_t(n) * sizeof(double));
  memcpy(row + 2 + n, sensor.moved + series->second, 2 * sizeof(double));
}

}  // namespace

extern "C" {

int64_t sway_read_sensors(sway_readings *readings, int64_t now, int64_t done, double time) {
  sway_readings &by = *readings;
  const int64_t k = by.sensors, n = by.corrected;
  double *sensed = by.sensed + now % SWAY_SLOTS * ROWS * k;
  for (int64_t i = 0; i < k; i++) sense(by, by.shapes + 6 * by.coordinates * i, sensed + ROWS * i);
  double *still = by.still + now % SWAY_SLOTS * n;
  for (int64_t i = 0; i < n; i++) still[i] = by.air_damping[i] * by.rate[i] + by.force[i];
  follow_lags(by, time);
  const int64_t then = now - by.late;
  if (then <= done) {
    for (int64_t i = 0; i < k; i++) by.is_known[i] = 0;
    return -1;
  }
  const double *computed = by.sensed + then % SWAY_SLOTS * ROWS * k;
  for (int64_t i = 0; i < k; i++) {
    sway_sensor &sensor = *by.sensor[i];
    const double when = time - double(by.late) * sensor.dt;
    by.is_known[i] = read_sensor(sensor, when, computed + ROWS * i, by.beyond + 9 * i);
    if (by.is_known[i]) add_to_series(sensor, by.still + then % SWAY_SLOTS * n, n);
  }
  return then;
}

void sway_judge(sway_sensor *judged, double size) {
  sway_sensor &sensor = *judged;
  sensor.usual = fmin(sensor.usual, MOST_USUAL);
  sensor.excess += sensor.dt / AVERAGED * (fmin(size, LARGEST) - sensor.excess);
  sensor.thrown = size > THROWN * sensor.usual ? sensor.thrown + sensor.dt : 0.0;
  if (sensor.is_refused) {
    sensor.agreed = sensor.excess < AGREES * sensor.usual ? sensor.agreed + sensor.dt : 0.0;
    if (sensor.agreed > TRUSTED_AGAIN) sensor.is_refused = 0;
  } else if (sensor.excess > DISAGREES * sensor.usual || sensor.thrown > THROWN_FOR) {
    sensor.is_refused = 1;
    sensor.in_use = 0;
    sensor.agreed = 0.0;
    sensor.disagreements++;
  } else {
    const double usual = fmin(fmax(sensor.excess, 1.0), MOST_USUAL);
    const double more = usual - sensor.usual;
    sensor.usual += sensor.dt / (more > 0.0 ? USUAL_UP : USUAL_DOWN) * more;
  }
  if (!sensor.is_refused && sensor.is_mounted) sensor.in_use = 1;
}

void sway_correct(const sway_filter *filter, const sway_readings *readings, size_t steps) {
  const int64_t n = filter->coordinates, p = filter->measurements;
  double *state = filter->state, *calm = filter->calm;
  double *last = filter->innovations;
  for (size_t step = 0; step < steps; step++) {
    expect(*filter, last);
    move(n, filter->law, 3, calm);
  }
  double largest = 0.0;  // of the quantities of a sensor
  for (int64_t k = 0; k < p; k += 3) {
    const int64_t at = filter->row[k] / 9;
    sway_sensor &sensor = *readings->sensor[at];
    const bool is_known = readings->is_known[at] && sensor.in_use;
    double size = 0.0;
    for (int64_t j = k; j < k + 3; j++) {
      const double innovation = is_known ? readings->beyond[filter->row[j]] - last[j] : 0.0;
      const double deviation = filter->deviation[j], share = innovation / deviation;
      size += share * share / 3.0;
      last[j] = limited(innovation, CLIPPED * deviation);
    }
    // What may be thrown moves nothing: its part would stay in the state when the sensor is left.
    const double counts = size > THROWN * sensor.usual ? 0.0 : 1.0;
    for (int64_t j = k; j < k + 3; j++) {
      last[j] *= counts;
      add_row(3 * n, last[j], filter->gain + 3 * n * j, state);
    }
    largest = fmax(largest, size);
    if (k + 3 < p && filter->row[k + 3] / 9 == at) continue;
    if (is_known)
      sway_judge(&sensor, largest);
    else
      readings->is_known[at] = 0;
    largest = 0.0;
  }
  for (int64_t i = 0; i < 3 * n; i++) calm[i] += PACE * (state[i] - calm[i]);
}

void sway_try(const sway_filter *filter, const double *measured, size_t steps, double *squares) {
  const int64_t n = filter->coordinates, p = filter->measurements;
  double *last = filter->innovations;
  for (size_t step = 0; step < steps; step++) {
    expect(*filter, last);
    for (int64_t k = 0; k < p; k++) {
      const double innovation = measured[int64_t(step) * p + k] - last[k];
      squares[k] += innovation * innovation;
      add_row(3 * n, innovation, filter->gain + 3 * n * k, filter->state);
    }
  }
}

void sway_carry(const sway_correction *correction, const double *ahead, const double *calm,
                double share, const double *eta, const double *rate) {
  const int64_t n = correction->coordinates;
  double *trust = correction->trust, *moved = correction->moved, *moving = moved + n;
  double whole = 0.0, own = 0.0, most = 0.0;
  for (int64_t i = 0; i < n; i++) {
    trust[i] += share * (correction->wanted[i] - trust[i]);
    most = fmax(most, trust[i]);
  }
  for (int64_t i = 0; i < n; i++) {
    for (int64_t j = 0; j < 2; j++) {
      const double *by = ahead + 3 * j * n + i;
      moved[j * n + i] =
          trust[i] * (by[0] * calm[i] + by[n] * calm[n + i] + by[2 * n] * calm[2 * n + i]);
    }
    const double stiffness = correction->stiffness[i], x = eta[i], v = rate[i];
    const double force = ahead[8 * n + i] * calm[2 * n + i], lean = force / stiffness;
    moved[2 * n + i] = trust[i] * force;
    moved[i] += fmax(most * correction->leaning[i] - trust[i], 0.0) * lean;
    const double at = x + moved[i], going = v + moving[i];
    whole += stiffness * at * at + going * going;
    own += stiffness * x * x + v * v;
  }
  correction->energies[0] = whole;
  correction->energies[1] = own;
}

void sway_drag(const sway_dragged *dragged, const double *correction, size_t steps, double *added) {
  const int64_t m = dragged->coordinates, n = dragged->corrected;
  double *state = dragged->state, *force = state + 2 * m;
  for (int64_t i = 0; i < m; i++) force[i] = 0.0;
  for (int64_t j = 0; j < n; j++) {
    add_row(m, correction[n + j], dragged->drag + j * m, force);
    add_row(m, correction[2 * n + j], dragged->push + j * m, force);
  }
  for (int64_t j = 0; j < n; j++) force[j] *= 1.0 - dragged->trust[j];
  for (size_t step = 0; step < steps; step++) move(m, dragged->law, 2, state);
  memcpy(added, state, size_t(2 * m) * sizeof(double));
  for (int64_t j = 0; j < n; j++) {
    added[j] += correction[j];
    added[m + j] += correction[n + j];
  }
}
}
