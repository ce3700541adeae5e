// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A model as it is stepped and placed: the arrays of doc/sway_model.md, laid out for vectors.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "memory.h"
#include "sway.h"

namespace sway {

constexpr int AZIMUTHS = 24, LEVELS = 7, HARMONICS = 21;

// Sizes of arrays that are names, as in `MEANINGS`.
enum Size : int64_t {
  SIZE_n = -1,            // segments
  SIZE_b = -2,            // branches
  SIZE_b_plus_1 = -3,     //
  SIZE_k = -4,            // most key rotations of a branch
  SIZE_N = -5,            // key rotations
  SIZE_m = -6,            // coordinates
  SIZE_q = -7,            // leading coordinates
  SIZE_s = -8,            // streamed coordinates
  SIZE_delays = -9,       // delays of limbs
  SIZE_any = -10,
  SIZES = 11,
};

enum Group {
  NUMBERS,
  TREE,
  PLACING,
  LOADS,
  COORDINATES,
  STREAM,
  TABLE,
  ISOLATED,
  LIMBS,
  LIMB_LOADS,
  LIMP,
};

// The arrays as they are in the bytes of a model; those that it lacks are null.
struct Arrays {
#define SWAY_ARRAY(type, name, group, ...) const type *name;
#include "arrays.inc"
#undef SWAY_ARRAY
  int64_t size[SIZES];  // by -Size

  // An array by its number in arrays.inc.
  const void *&operator[](int number) { return reinterpret_cast<const void **>(this)[number]; }
};

// Segments at the same place in sixteen branches are placed at once: a slot each.
constexpr int WIDTH = 16;

// Segments of the branches of a block, the same number from the base of each.
struct Segment {
  double slope[WIDTH];
  double tip_slope[WIDTH];  // under a load at the tip, less `slope`
  double chord[3][WIDTH];   // in the frame of the segment [m]
  double rest[4][WIDTH];    // orientation at rest, w x y z
  double *turn;             // rotation vector per unit of each key rotation (rows, 3, WIDTH)
  int64_t n_slots;          // branches that have this segment, in the first slots
};

INLINE void raise_to(int64_t &largest, int64_t value) {
  if (value > largest) largest = value;
}

// Sixteen branches; parents are in earlier blocks than their children.
struct Block {
  int64_t first_record, n_records;  // its segments
  int64_t n_slots;
  int64_t n_parents;      // slots up to the last branch that has children
  int64_t n_rows;         // most key rotations of a branch
  int64_t n_parent_rows;  // most key rotations of a parent
  int64_t is_joined;      // 1 where each segment starts at the end of the one before
  int64_t is_at_axes;     // 1 where all bases are on the axes of their base segments
  int64_t branch[WIDTH], parent[WIDTH], coordinate[WIDTH], parent_coordinate[WIDTH];
  int64_t base_segment[WIDTH], first[WIDTH];
  double axes[2][3][WIDTH];  // e1, e2 of `branch_frame`
  double skew[WIDTH], tip_skew[WIDTH];  // the second less the first
  double offset[3][WIDTH];
  double bound_factor[WIDTH];  // key rotations less one
  double *steepest;            // largest squared rotation of a segment per unit (rows, WIDTH)
  double *base_rotation;       // per unit of each key rotation of the parent (rows, 3, WIDTH)
};

// Points of a segment at which mass and drag are: Gauss's, so that a segment that turns about its
// middle has its inertia, and is damped.
constexpr int64_t POINTS = 2;

// A limp tree at rest, one that is solved at its pose ("A limp tree" of doc/sway_model.md). A place
// is the points of the segments, each times the root of its mass: `places` numbers, x of all
// segments, then y and z, `each` of them.
struct Limp {
  int64_t leading;  // q: coordinates whose inertia is that of the pose
  int64_t row;      // q and three right-hand sides, up to whole vectors
  int64_t each, places, keys;  // up to whole vectors
  double *shapes;        // (keys / 32, m, 32)
  double *directions;    // key rotations per unit of each coordinate (m, keys)
  double *amount;        // of each coordinate for the difference of its column (m)
  double *columns;       // places per unit of each coordinate, J (m, places)
  double *factor;        // Cholesky factor of the inertia of the places (q, row)
  double *weight;        // force of the weight on leading coordinates (q)
  double *slopes;        // derivative of this force by each coordinate (q, padded)
  double *force;         // of the weight, on the model's coordinates (padded)
  double *all_slopes;    // its derivative by each coordinate (m, padded)
  double *gravity;       // along z, over the factor of each place (each)
  double potential;            // of this at rest
  double *root_mass, *from_start;  // (each)
  double *area, *speed;             // drag area [m^2], wind over that of the tree (each)
  int64_t *delay;                   // of the gusts at each segment (n); null without
  double *damping;                  // by still air, per drag and speed (padded)
};

}  // namespace sway

struct sway_model {
  sway::Memory memory;
  sway_sizes sizes;
  int64_t rows;    // room for key rotations of a branch, k
  int64_t padded;  // coordinates, up to whole vectors

  int64_t n_blocks;
  sway::Block *blocks;
  sway::Segment *segments;

  double *stiffness, *own_damping;  // (padded), 1 and 0 after the last
  float *shapes;                    // (keys / 64, m, 64), rounded up
  // Numbers, limbs and the table of winds, if it is stepped by one: rows of coordinates have `padded`
  // numbers, zeros after the last.
  sway::Arrays table;

  sway::Limp limp;  // where `is_limp`
};

namespace sway {

#ifdef SWAY_PAGE  // a page steps every tree on its table
constexpr bool ON_TABLES = true;
#else
constexpr bool ON_TABLES = false;
#endif

INLINE bool is_limp(const sway_model &model) { return !ON_TABLES && model.sizes.is_stepped == 2; }

}  // namespace sway
