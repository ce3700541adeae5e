// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Gusts travel: a place feels the wind of the anemometer after a delay ("Gusts" of
// doc/sway_model.md).
#pragma once

#include "frame.h"
#include "vec.h"

namespace sway {

// Delays with which gusts reach the limbs of a tree, and steps of their history.
constexpr int DELAYS = 16, HISTORY = 256;

// The last wind: rows of time [s] and the integral of the wind [m] at the ends of steps, in a ring of
// `size` rows of which `count` are used, the last at `last`.
struct History {
  double *last, *count;  // whole numbers
  FourAt *run;           // (size)
  int64_t size;
};

// Add a step of dt [s] in a wind [m/s]; steps shorter than `finest` [s] are joined.
void remember(const History &history, double finest, const double wind[3], double dt);

// Move delays [s] towards those wanted, at most `longest`, and write the mean of the past wind over
// the step of each (count, 3).
void past_winds(const History &history, const double *wanted, double *delays, int64_t count,
                double longest, const double wind[3], double dt, double *out);

// Wind of the limbs of a tree, as it lies in its state.
struct Crown {
  double last, count, run[4 * HISTORY];  // its `History`
  double mean[2], averaged;              // mean wind [m/s], and the time that it spans [s]
  double wanted[DELAYS];                 // delays by the mean wind [s]
  double delay[DELAYS];                  // delays in use [s]
  double apart[3 * DELAYS];              // wind of each delay less the wind [m/s]
};

// Numbers of the memory of a crown.
constexpr int64_t CROWN = sizeof(Crown) / sizeof(double);

INLINE Crown &crown_of(double *memory) { return *reinterpret_cast<Crown *>(memory); }

// Add a step in a wind; `spread` [m] is the longest delay times the wind speed, `coherence` the
// share of the wind that reaches the whole crown at once. Without a spread the winds of the limbs
// are those that were written.
void push_crown(Crown &crown, double spread, double coherence, const double wind[3], double dt);

}  // namespace sway
