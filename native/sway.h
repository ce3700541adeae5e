/* Copyright 2026 Tree Sway maintainers
 * SPDX-License-Identifier: Apache-2.0
 *
 * Trees that sway: the C interface of the native core.
 *
 * A model is the bytes of a .sway file (`tree-sway convert oak.yaml -o oak.sway`), which holds the
 * arrays of doc/sway_model.md. A stand is trees of some models, each at a place; a tree alone is a
 * stand of one. A frame is `sway_step`, then `sway_place`. Nothing is allocated between
 * `*_open` and `*_close`.
 *
 * Units are SI. The wind is the velocity of the air, x east, y north, z up [m/s]. A pose is seven
 * numbers: x y z of the root-side node of a segment [m], then the quaternion x y z w of its
 * orientation, whose x axis is along the segment.
 *
 * A limp tree, whose twigs hang or whip, is stepped at its pose and not by a table: in some 0.1 ms in
 * place of 0.01, and with some hundred kilobytes for each tree beside its state.
 *
 * A stand is used by one thread at a time, but for ranges of trees: `sway_step`, `sway_place`,
 * `sway_keys` and `sway_place_keys` may run at once for different trees in different rooms, or a
 * stand has threads of its own: `SWAY_EVERY_ROOM`. The result does not depend on how trees are
 * shared out.
 */
#ifndef SWAY_H
#define SWAY_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define SWAY_API __declspec(dllexport)
#else
#define SWAY_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this interface and of the bytes of a model. */
#define SWAY_VERSION 1

typedef struct sway_model sway_model;
typedef struct sway_stand sway_stand;

/* Sizes of a model. */
typedef struct sway_sizes {
  int64_t segments;     /* n: poses of a tree */
  int64_t branches;     /* b */
  int64_t keys;         /* N: key rotations of all branches */
  int64_t coordinates;  /* m: coordinates that are solved */
  int64_t delays;       /* delays with which gusts reach limbs; 0 if they reach all at once */
  int64_t is_stepped;   /* 1 by its table, 2 at its pose (a limp tree); 0 if it is only placed */
} sway_sizes;

/* A tree of a stand. */
typedef struct sway_tree {
  int64_t model;  /* number of its model */
  double at[3];   /* root node [m] */
  double yaw;     /* turn about the vertical [rad] */
  double scale;   /* size over that of its model */
  double speed;   /* wind at its height over that at the height of its model */
} sway_tree;

/* Bits of the result of `sway_step`. */
enum { SWAY_OK = 0, SWAY_CLAMPED = 2, SWAY_RESTARTED = 4 };

/* The version of the library, to be compared with SWAY_VERSION. */
SWAY_API int sway_version(void);

/* Read and check a model: every array, its type, shape, range and indices. Returns NULL if the
 * bytes are no model; then `error` (of `room` bytes, may be NULL) names the array. The bytes are
 * copied. */
SWAY_API sway_model *sway_model_open(const void *bytes, size_t size, char *error, size_t room);

SWAY_API void sway_model_close(sway_model *model);

SWAY_API void sway_model_sizes(const sway_model *model, sway_sizes *sizes);

/* In place of a room: `sway_step` and `sway_place` share the trees among as many threads as there are
 * rooms, of which the caller is one. The others are started with the stand and sleep between calls;
 * after a fork the child starts its own. */
#define SWAY_EVERY_ROOM SIZE_MAX

/* Make a stand at rest. Models must outlive it. `rooms` is the number of threads that may work
 * at once; 0 is one for each processor that the process may use, up to eight, in a stand of some
 * 100,000 segments or more, and 1 in a smaller one. Returns NULL, with `error`, for a tree whose numbers are not finite, whose scale is not
 * above 0 or whose model does not exist, or where memory is short. */
SWAY_API sway_stand *sway_stand_open(const sway_model *const *models, size_t n_models,
                                     const sway_tree *trees, size_t n_trees, size_t rooms,
                                     char *error, size_t room);

SWAY_API void sway_stand_close(sway_stand *stand);

/* The state of all trees, `*stride` numbers for each, which may be read and written between
 * steps: rows of `*width` numbers for coordinates, their rates [1/s], the force of the last step
 * [1/s^2], what is hidden of each coordinate, the derivative of the force by the own rate and the
 * force of the wind; then wind [m/s] (3), drag density [kg/m^3], whether the last step was clamped,
 * the number of last coordinates that are neither shown nor loaded, and the number of last
 * coordinates that are kept at rest; then one number more, and the history of the wind where gusts
 * reach limbs one after another. */
SWAY_API double *sway_state(sway_stand *stand, size_t *stride, size_t *width);

/* Set stiffness [1/s^2] and damping [1/s] of the coordinates (m) of a model of the stand, from the
 * next `sway_set_step` on. Returns 0, or -1 for numbers that are not finite or negative. */
SWAY_API int sway_tune(sway_stand *stand, size_t model, const double *stiffness,
                       const double *damping);

/* Set the length of the steps [s]. Returns 0, or -1 unless it is above 0 and finite. */
SWAY_API int sway_set_step(sway_stand *stand, double dt);

/* Step trees `first` to `first + count - 1` in the wind at each (count, 3), mean over the step.
 * A wind beyond the range of a model is clamped; one of 1e100 m/s or that is not finite is calm.
 * Returns the bits above of all these trees; `counts` (may be NULL) has the trees that were clamped
 * and those that were not finite and went on from rest. */
SWAY_API int sway_step(sway_stand *stand, size_t room, size_t first, size_t count,
                       const double *winds, int64_t counts[2]);

/* Place trees: `rows` (count, 2) has the number of each and its first row of `poses`. Many are placed
 * sooner where those of a model follow each other. */
SWAY_API void sway_place(sway_stand *stand, size_t room, const int64_t *rows, size_t count,
                         double *poses);

/* The key rotations (N) [rad] of a tree. */
SWAY_API void sway_keys(sway_stand *stand, size_t room, size_t tree, double *keys);

/* Place a tree by key rotations (N) [rad], in rows `poses` of its own (n, 7). */
SWAY_API void sway_place_keys(sway_stand *stand, size_t room, size_t tree, const double *keys,
                              double *poses);

/* Winds of places that gusts reach after a delay. `history` has 2 + 4 `size` numbers, at first 0.
 * Unless `finest` is negative a step of dt [s] in a mean wind [m/s] is added to it, joined with the
 * one before if both are not longer than `finest` [s]. `delays` [s] (count) move towards `wanted`,
 * at most `longest`; `out` (count, 3) has the mean of the past wind over the step of each. */
SWAY_API void sway_past_winds(double *history, size_t size, double finest, const double *wanted,
                              double *delays, size_t count, double longest, const double *wind,
                              double dt, double *out);

/* Winds of the limbs of a tree by delay, less the wind: the last 48 of 1109 numbers of `memory`, at
 * first 0, after a step of dt [s]. `spread` [m] is the longest delay times the wind speed,
 * `coherence` the share of the wind that reaches all limbs at once. */
SWAY_API void sway_limb_winds(double *memory, double spread, double coherence, const double *wind,
                              double dt);

#ifdef __cplusplus
}
#endif

#endif
