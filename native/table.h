// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A step of the coordinates of a tree in a uniform wind ("A step" and "The force" of
// doc/sway_model.md).
//
// A wind and a mean deflection lie between four corners of the table: at the azimuths before and
// after the wind, and at the levels of the deflection below and above that of the tree.
#pragma once

#include "frame.h"
#include "turn.h"

namespace {

using namespace sway;

constexpr double AIR_DENSITY = 1.225;                           // [kg/m^3], ISO 2533
constexpr double STREAMLINING_FROM = 4.0, STREAMLINING_TO = 20.0;  // of the drag law [m/s]

// Sine of the elevation above which slopes are blended with those of vertical wind.
constexpr double STEEP = 0.70710678118654752440;

constexpr int MOST_PASSES = 8;  // in which the force of a step is found

// Change of the force in a pass over that of the first, and the share of the change before it: a
// heavy ball (Polyak 1964, USSR Computational Mathematics and Mathematical Physics 4, 1-17).
constexpr double STRIDE = 1.5, MOMENTUM = 0.1;

// Drag per area and squared speed, 1/2 rho (C U^-N + C0) [kg/m^3].
INLINE double drag_density(const double law[3], double speed) {
  if (law[1] == 0.0) return 0.5 * AIR_DENSITY * (law[0] + law[2]);
  const double streamlined = least(most(speed, STREAMLINING_FROM), STREAMLINING_TO);
  return 0.5 * AIR_DENSITY * (law[0] * __builtin_pow(streamlined, -law[1]) + law[2]);
}

struct Wind {
  Vector<double> direction;  // a unit vector
  double dynamic_pressure;   // p U^2 [kg/m/s^2]
  double per_speed_squared;  // p [kg/m^3]
};

// Real spherical harmonics of degree 1, 3 and 5 at a unit vector, as harmonic polynomials; those of
// a degree n are 2 n + 1 numbers about a centre, by sines before it and by cosines behind.
void fill_harmonics(const Vector<double> &at, double *out) {
  // Cosine and sine of m times the azimuth, times the m-th power of the horizontal part.
  double cosine[6] = {1.0}, sine[6] = {0.0};
  for (int m = 1; m < 6; m++) {
    cosine[m] = at.x * cosine[m - 1] - at.y * sine[m - 1];
    sine[m] = at.x * sine[m - 1] + at.y * cosine[m - 1];
  }
  const double z = at.z, zz = z * z;
  // Of each degree by m, over the horizontal part.
  const double upright[] = {1.7320508075688772 * z,
                            1.7320508075688772,
                            1.3228756555322954 * z * (5.0 * zz - 3.0),
                            1.620185174601965 * (5.0 * zz - 1.0),
                            5.123475382979799 * z,
                            2.091650066335189,
                            0.414578098794425 * z * (63.0 * zz * zz - 70.0 * zz + 15.0),
                            1.6056540723331412 * (21.0 * zz * zz - 14.0 * zz + 1.0),
                            8.496322733983215 * z * (3.0 * zz - 1.0),
                            1.734304615688951 * (9.0 * zz - 1.0),
                            7.358031326380718 * z,
                            2.3268138086232857};
  const double *by_m = upright;
  double *centre = out + 1;
  for (int degree = 1; degree <= 5; by_m += degree + 1, centre += 2 * degree + 3, degree += 2) {
    for (int m = 0; m <= degree; m++) {
      centre[-m] = by_m[m] * sine[m];
      centre[m] = by_m[m] * cosine[m];
    }
  }
}

// The four corners around a wind and a mean deflection, and their bilinear weights; 0: azimuth
// before, level below; 1: before, above; 2: after, below; 3: after, above.
struct Corners {
  int64_t azimuth[2];
  double by_azimuth[2], by_level[2];  // shares of before and after, below and above
  int64_t number[4];
  double weight[4];
};

// `level_winds` is the share of the slopes of winds that are not steep.
Corners find_corners(const sway_model &model, const Wind &wind, const double *eta,
                     double level_winds) {
  const Arrays &table = model.table;
  const int64_t M = model.padded;
  const double position =
      __builtin_atan2(wind.direction.y, wind.direction.x) * (AZIMUTHS / (360.0 * DEGREE));
  const double whole = __builtin_floor(position);
  Corners corners;
  corners.azimuth[0] = (int64_t(whole) + AZIMUTHS) % AZIMUTHS;
  corners.azimuth[1] = (corners.azimuth[0] + 1) % AZIMUTHS;
  const double share = position - whole, rest = 1.0 - share;
  const double *before = table.amount + corners.azimuth[0] * M;
  const double *after = table.amount + corners.azimuth[1] * M;
  Vec deflections = {};
  for (int64_t i = 0; i < M; i += LANES)
    deflections += (rest * load(before + i) + share * load(after + i)) * load(eta + i);
  const double deflection = sum(deflections);
  const double *low = table.levels + corners.azimuth[0] * LEVELS;
  const double *high = table.levels + corners.azimuth[1] * LEVELS;
  int64_t level = 0;
  double below = rest * low[0] + share * high[0], above = rest * low[1] + share * high[1];
  while (level < LEVELS - 2 && deflection > above) {
    level++;
    below = above;
    above = rest * low[level + 1] + share * high[level + 1];
  }
  const double climbed = least(most((deflection - below) / (above - below), 0.0), 1.0);
  corners.by_azimuth[0] = rest;
  corners.by_azimuth[1] = share;
  corners.by_level[0] = 1.0 - climbed;
  corners.by_level[1] = climbed;
  for (int corner = 0; corner < 4; corner++) {
    const int is_after = corner / 2, is_above = corner % 2;
    corners.number[corner] = corners.azimuth[is_after] * LEVELS + level + is_above;
    corners.weight[corner] =
        level_winds * corners.by_azimuth[is_after] * corners.by_level[is_above];
  }
  return corners;
}

// A value of coordinates from i on, between the corners.
INLINE Vec between(const double *values, int64_t M, const Corners &corners, int64_t i) {
  Vec found = corners.weight[0] * load(values + corners.number[0] * M + i);
  for (int corner = 1; corner < 4; corner++)
    found += corners.weight[corner] * load(values + corners.number[corner] * M + i);
  return found;
}

// How far the tree is from the equilibria at the corners, times their weights. Half of the way to
// each is taken, so that loads between levels are cubic.
void find_distances(const sway_model &model, const Corners &corners, Room &room) {
  const int64_t M = model.padded;
  const double *equilibrium = model.table.equilibrium;
  const double above = corners.by_level[1];
  const double to_below = 0.5 * above, to_above = 0.5 * corners.by_level[0];
  for (int64_t i = 0; i < M; i++) {
    const double low = equilibrium[corners.number[0] * M + i];
    const double other_low = equilibrium[corners.number[2] * M + i];
    const double rise = equilibrium[corners.number[1] * M + i] - low;
    const double other_rise = equilibrium[corners.number[3] * M + i] - other_low;
    const double away = room.middle[i] - corners.by_azimuth[0] * (low + above * rise) -
                        corners.by_azimuth[1] * (other_low + above * other_rise);
    room.distance[i] = float(corners.weight[0] * (away + to_below * rise));
    room.distance[M + i] = float(corners.weight[1] * (away - to_above * rise));
    room.distance[2 * M + i] = float(corners.weight[2] * (away + to_below * other_rise));
    room.distance[3 * M + i] = float(corners.weight[3] * (away - to_above * other_rise));
    room.single_rate[i] = float(room.middle_rate[i]);
    room.turned[i] = room.damped[i] = 0.0f;
  }
}

// Add the load by the distances from the corners, and the damping by the rates, and write the damping
// by the own rate of each. The coordinate that moves is the outer loop: the table is read in order.
void add_slopes(const sway_model &model, const Corners &corners, double slant, double level_winds,
                double drag, double *diagonal, Room &room, int64_t n_coupled) {
  const int64_t m = model.sizes.coordinates, M = model.padded;
  const Arrays &table = model.table;
  const float *turning[4], *damping[4];
  float weight[4];
  for (int corner = 0; corner < 4; corner++) {
    turning[corner] = table.turning + corners.number[corner] * m * M;
    damping[corner] = table.damping + corners.number[corner] * m * M;
    weight[corner] = float(corners.weight[corner]);
  }
  const float *lean[2];
  float slants[2];
  for (int side = 0; side < 2; side++) {
    lean[side] = table.lean + corners.azimuth[side] * m * M;
    slants[side] = float(level_winds * corners.by_azimuth[side] * slant);
  }
  for (int64_t moving = 0; moving < m; moving++) {
    const int64_t row = moving * M;
    double own = 0.0;
    for (int corner = 0; corner < 4; corner++)
      own += corners.weight[corner] * double(damping[corner][row + moving]);
    diagonal[moving] = drag * own;
    if (moving >= n_coupled) continue;
    const float moved = float(room.middle[moving]);
    const float rate = room.single_rate[moving];
    float away[4], rates[4];
    for (int corner = 0; corner < 4; corner++) {
      away[corner] = room.distance[corner * M + moving];
      rates[corner] = weight[corner] * rate;
    }
    for (int64_t i = 0; i < M; i += 2 * LANES) {
      Singles turned = load(room.turned + i), damped = load(room.damped + i);
      for (int corner = 0; corner < 4; corner++) {
        turned += away[corner] * load(turning[corner] + row + i);
        damped += rates[corner] * load(damping[corner] + row + i);
      }
      turned += slants[0] * moved * load(lean[0] + row + i);
      turned += slants[1] * moved * load(lean[1] + row + i);
      store(room.turned + i, turned);
      store(room.damped + i, damped);
    }
  }
}

// Add the slopes in winds straight up or down, by the share that the wind has of them.
void add_steep_slopes(const sway_model &model, bool is_upwards, double steepness, double drag,
                      State &state, Room &room, int64_t n_coupled) {
  const int64_t m = model.sizes.coordinates, M = model.padded;
  const float *turning = model.table.steep_turning + (is_upwards ? m * M : 0);
  const float *damping = model.table.steep_damping + (is_upwards ? m * M : 0);
  for (int64_t moving = 0; moving < n_coupled; moving++) {
    const float moved = float(steepness * room.middle[moving]);
    const float rate = float(steepness) * room.single_rate[moving];
    for (int64_t i = 0; i < M; i += 2 * LANES) {
      store(room.turned + i, load(room.turned + i) + moved * load(turning + moving * M + i));
      store(room.damped + i, load(room.damped + i) + rate * load(damping + moving * M + i));
    }
    state.diagonal[moving] += drag * steepness * double(damping[moving * M + moving]);
  }
}

// The force of a wind on the coordinates in the middle of the step, `wanted`, and its derivative by
// the own rate of each, `diagonal`, with all others at equal rates. Of the coordinates from
// `n_coupled` on each damps only itself.
void find_wind_force(const sway_model &model, const Wind &wind, State &state, Room &room,
                     int64_t n_coupled) {
  const int64_t m = model.sizes.coordinates, M = model.padded;
  const Arrays &table = model.table;
  double harmonics[HARMONICS];
  fill_harmonics(wind.direction, harmonics);
  const double steepness = most(0.0, (__builtin_fabs(wind.direction.z) - STEEP) / (1.0 - STEEP));
  const Corners corners = find_corners(model, wind, room.middle, 1.0 - steepness);
  Vec squares = {};
  for (int64_t i = 0; i < M; i += LANES) {
    const Vec rate = load(room.middle_rate + i);
    squares += load(table.motion + i) * rate * rate;
  }
  const double p = wind.per_speed_squared;
  const double square = p > 0.0 ? wind.dynamic_pressure / p : 0.0;
  const double drag = p * __builtin_sqrt(square + sum(squares));
  for (int64_t i = 0; i < M; i += LANES) {
    Vec force = between(table.load, M, corners, i);
    for (int number = 0; number < HARMONICS; number++)
      force += harmonics[number] * load(table.harmonics + number * M + i);
    store(state.wanted + i, force);
  }
  find_distances(model, corners, room);
  add_slopes(model, corners, least(most(wind.direction.z, -STEEP), STEEP), 1.0 - steepness, drag,
             state.diagonal, room, n_coupled);
  for (int64_t i = m; i < M; i++) state.diagonal[i] = 0.0;
  if (steepness > 0.0)
    add_steep_slopes(model, wind.direction.z > 0.0, steepness, drag, state, room, n_coupled);
  // Slopes hold near an equilibrium; the load far from it is bounded by that of any wind.
  for (int64_t i = 0; i < M; i += LANES) {
    const Vec limit = load(table.limit + i);
    const Vec force = load(state.wanted + i) + load_singles(room.turned + i);
    const Vec bounded = least(most(force, -limit), limit);
    store(state.wanted + i, wind.dynamic_pressure * bounded + drag * load_singles(room.damped + i));
  }
  for (int64_t i = n_coupled; i < m; i++)
    state.wanted[i] += state.diagonal[i] * room.middle_rate[i];
  for (int64_t i = 0; i < M; i += LANES)
    store(state.diagonal + i,
          load(state.diagonal + i) - drag * between(table.cross_damping, M, corners, i));
}

// Move M coordinates of some rates by rows of coefficients under a force.
void move(const double *c, int64_t M, const double *from, const double *at_rate,
          const double *force, double *eta, double *rate) {
  for (int64_t i = 0; i < M; i += LANES) {
    const Vec q = load(from + i), v = load(at_rate + i), f = load(force + i);
    store(eta + i, load(c + i) * q + load(c + M + i) * v + load(c + 2 * M + i) * f);
    store(rate + i, load(c + 3 * M + i) * q + load(c + 4 * M + i) * v + load(c + 5 * M + i) * f);
  }
}

// Write the state at the middle of the step.
void move_to_middle(const sway_model &model, const Step &step, const State &state, Room &room) {
  move(step.half, model.padded, state.eta, state.rate, state.force, room.middle, room.middle_rate);
}

// Twice the energy of strain and motion [J].
double twice_energy(const sway_model &model, const double *stiffness, const State &state) {
  Vec energy = {};
  for (int64_t i = 0; i < model.padded; i += LANES) {
    const Vec q = load(state.eta + i), v = load(state.rate + i);
    energy += load(stiffness + i) * q * q + v * v;
  }
  return sum(energy);
}

// Find the force by that of the wind, implicit in all damping with equal rates of the other
// coordinates: stable in any wind and for any step. Returns by how many times at most the drag on a
// coordinate stops it within half a step.
double find_force(const sway_model &model, const Step &step, State &state, Room &room) {
  const double *per_force = step.half + 5 * model.padded;
  Vec stiffest = {};
  for (int64_t i = 0; i < model.padded; i += LANES) {
    const Vec before = load(state.force + i);
    const Vec own = load(state.diagonal + i) * load(per_force + i);
    const Vec force = (load(state.wanted + i) - own * before) / (1.0 - own);
    store(state.force + i, force);
    store(room.change + i, force - before);
    stiffest = most(stiffest, -own);
  }
  return largest(stiffest);
}

// Change the force towards that of the wind in the motion which it makes itself.
void change_force(const sway_model &model, const Step &step, State &state, Room &room) {
  const double *per_force = step.half + 5 * model.padded;
  for (int64_t i = 0; i < model.padded; i += LANES) {
    const Vec bound = 1.0 - load(state.diagonal + i) * load(per_force + i);
    const Vec lacking = (load(state.wanted + i) - load(state.force + i)) / bound;
    const Vec change = STRIDE * lacking + MOMENTUM * load(room.change + i);
    store(room.change + i, change);
    store(state.force + i, load(state.force + i) + change);
  }
}

// The coordinates that are kept at rest.
INLINE void keep_at_rest(const sway_model &model, State &state) {
  const int64_t m = model.sizes.coordinates;
  for (int64_t i = m - count_of(*state.at_rest, m); i < m; i++) state.eta[i] = state.rate[i] = 0.0;
}

// Step a tree in a uniform wind [m/s] in its own frame, of a drag density [kg/m^3]. Returns whether
// wind or energy were clamped.
bool step_table(const sway_model &model, const double *stiffness, const Step &step, State &state,
                Room &room, const Vector<double> &velocity, double per_speed_squared) {
  const Arrays &table = model.table;
  const double speed = __builtin_sqrt(dot(velocity, velocity));
  const double pressure = per_speed_squared * speed * speed;
  bool is_clamped = pressure > *table.most_pressure;
  const Vector<double> direction = {velocity.x / speed, velocity.y / speed, velocity.z / speed};
  const Wind wind = {speed > 0.0 ? direction : Vector<double>{1.0, 0.0, 0.0},
                     least(pressure, *table.most_pressure), per_speed_squared};
  const int64_t n_coupled =
      model.sizes.coordinates - count_of(*state.left_out, model.sizes.coordinates);
  const double energy_before = twice_energy(model, stiffness, state);
  move_to_middle(model, step, state, room);
  find_wind_force(model, wind, state, room, n_coupled);
  double stiffest = find_force(model, step, state, room);
  // The bound by the damping of all coordinates lags where drag stops a coordinate within half a
  // step: light leaves on thin petioles. Twice the drag takes one pass more.
  for (int pass = 1; stiffest > 1.0 && pass < MOST_PASSES; stiffest *= 0.5, pass++) {
    move_to_middle(model, step, state, room);
    find_wind_force(model, wind, state, room, n_coupled);
    change_force(model, step, state, room);
  }
  move(step.whole, model.padded, state.eta, state.rate, state.force, state.eta, state.rate);
  keep_at_rest(model, state);
  // A pull may bend a tree more than any wind; no wind adds to that.
  const double energy = twice_energy(model, stiffness, state);
  const double most_energy = most(energy_before, *table.most_energy);
  if (!(energy <= most_energy)) {
    const double scale = __builtin_sqrt(most_energy / energy);
    for (int64_t i = 0; i < model.padded; i++) {
      state.eta[i] *= scale;
      state.rate[i] *= scale;
    }
    is_clamped = true;
  }
  write(state.wind, velocity);
  *state.drag_density = per_speed_squared;
  *state.is_clamped = is_clamped;
  return is_clamped;
}

}  // namespace
