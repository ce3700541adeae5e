/* Copyright 2026 Tree Sway maintainers
 * SPDX-License-Identifier: Apache-2.0
 *
 * What the Python library calls beside sway.h. It is not part of the public interface: functions may
 * change with any version, and arrays are not checked here.
 *
 * Memory is the caller's, who keeps it and has checked its shapes. Units are SI; arrays are in rows,
 * (b, 3) is three numbers for each of b branches.
 */
#ifndef SWAY_LIBRARY_H
#define SWAY_LIBRARY_H

#include "sway.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of which headers the library is built: the CRC-32 of sway.h and library.h, one after the other.
 * Whoever calls what is declared here compares it, as memory is shared. */
SWAY_API uint32_t sway_interface(void);

/* The first tree of a stand, whose frames take so little time that arguments would tell. */
typedef struct sway_first {
  sway_stand *stand;
  const double *wind; /* mean over a step [m/s] (3) */
  double *poses;      /* (n, 7) */
} sway_first;

/* `sway_step` of the first tree, in the first room. */
SWAY_API int sway_step_first(const sway_first *first);

/* `sway_place` of the first tree, in the first room. */
SWAY_API void sway_place_first(const sway_first *first);

/* Coefficients of oscillators q'' + k2 q' + k1 q = f of stiffness k1 [1/s^2] and damping k2 [1/s]
 * (count) over a step of dt [s] under a constant force, and over half of it, to where the load of the
 * wind is found: rows (6, count) for the displacement by displacement, rate and force, then for the
 * rate. */
SWAY_API void sway_steps(const double *stiffness, const double *damping, size_t count, double dt,
                         double *whole, double *half);

/* Coefficients (count, 8) of oscillators I x'' + k2 x' + k1 x = M(t) over a step of dt [s] in which M
 * changes from M0 to M1 along a line: x by x, v, M0 and M1, then v by the same. An oscillator without
 * inertia has its first-order limit, one without damping too its static response. Returns the first
 * whose numbers are all zero, which is not moved, or -1. */
SWAY_API int64_t sway_propagators(const double *inertia, const double *damping,
                                  const double *stiffness, size_t count, double dt, double *out);

/* The branches of a tree for the load of the wind on them, parents before their children. In the
 * frames of their bases at rest, which are that of the tree; k is the most key rotations that a
 * branch has. */
typedef struct sway_branches {
  int64_t branches;             /* b */
  int64_t keys;                 /* k */
  const int64_t *parent;        /* (b); below 0 for the stem, which is the first */
  const int64_t *coordinate;    /* first of its key rotations (b) */
  const int64_t *n_coordinates; /* how many it has, at most k (b) */
  const double *twist;          /* motion of its base per unit of its parent's (b, k, 6) */
  const double *base;           /* base [m] (b, 3) */
  const double *arm;            /* base from that of its parent [m] (b, 3) */
  const double *per_arm;        /* 0.5 over the square of its length [1/m^2] (b) */
  const double *speed;          /* wind at it over that of the tree (b) */
  const double *area;           /* drag area [m^2] (b) */
  const double *spread;         /* variance of the motion of its pieces [m^2] (b) */
  const double *projector;      /* mean of 1 - t t^T: xx yy zz xy xz yz (b, 6) */
  const double *coupling;       /* moment about its base per force [m] (b, 3, 3) */
  const double *load_mode;      /* motion that the force does work on (b, k, 3) */
  const double *damping_mode;   /* motion that the drag damps (b, k, 3) */
  const double *load_rotation;  /* rotation of its loaded pieces (b, k, 3) */
} sway_branches;

/* Motion of a branch and the load on it. */
typedef struct sway_branch_load {
  double velocity[6];     /* velocity and spin of the base in its own, turned frame */
  double orientation[4];  /* of the base from rest, w x y z */
  double rotation[3];     /* rotation vector of the base from that of its parent */
  double displacement[3]; /* of the base in the frame of its parent's [m] */
  double arm[3];          /* the base from that of its parent, bent [m] */
  double turn[3];         /* rotation vector of the loaded pieces from the base */
  double flow[3];         /* of the air by the loaded pieces, in their frame [m/s] */
  double own_force[3];    /* of the wind in the frame of the loaded pieces [N] */
  double force[3];        /* the same in the frame of the tree [N] */
  double wrench[6];       /* force and moment on the branch and all it carries, at its base */
} sway_branch_load;

/* Moments [N m] of uniform winds (count, 3) [m/s] on the key rotations of a tree in poses x
 * (count, N) [rad] that move at v (count, N) [rad/s], or are still if v is NULL; the drag density
 * is 1 kg/m^3. `loads` (b) is written, and is left as of the last pose; so is `moments`
 * (count, N). */
SWAY_API void sway_wind_moments(const sway_branches *tree, const double *x, const double *v,
                                const double *winds, size_t count, sway_branch_load *loads,
                                double *moments);

/* Changes of these moments on a tree that is still at x (N) in a wind (3) by motion along shapes
 * (N, columns), key rotations by their number: `turning` by the motion, `damping` by its rate,
 * (N, columns) each [N m]. `columns` is a multiple of 8; `scratch` has room for 333 numbers for each
 * branch. */
SWAY_API void sway_load_slopes(const sway_branches *tree, const double *x, const double *wind,
                               const double *shapes, size_t columns, double *scratch,
                               double *turning, double *damping);

/* Sixteen branches of the model `branch`; a branch that is not there has zeros. */
typedef struct sway_branch_block {
  double speed[16];               /* wind at it over that of the tree */
  double area[16];                /* drag area [m^2] */
  double spread[16];              /* variance of the motion of its pieces [m^2] */
  double projector[6][16];        /* mean of 1 - t t^T: xx yy zz xy xz yz */
  double damping_mode[2][3][16];  /* by its key rotations: motion that the drag damps [m] */
  double load_rotation[2][3][16]; /* rotation of its loaded pieces */
  double load_mode[2][3][16];     /* motion that the force does work on [m] */
  double chord_lever[3][16];      /* direction of the chord times the lever of the load [m] */
  /* Set with the time step: */
  double compliance[16]; /* velocity half a step after a unit of force [s/kg] */
  double whole[8][16];   /* coefficients of the propagator of a step */
  double half[6][16];    /* of half a step under a constant load */
  double guard[3][16];   /* inertia of the gyroscopic term, limits of load and moment */
  /* Set with the wind: its wind less that of the tree [m/s] */
  double gust[3][16];
  /* State: */
  double drag_impulse[3][16]; /* change of the relative wind by the force, over compliance [N] */
  double load[3][16];         /* load along the chord and on its key rotations [N m] */
  double force[3][16];        /* of the wind [N] */
} sway_branch_block;

/* Step `count` branches in the wind x y z [m/s] of a drag density [kg/m^3], mean over the step:
 * key rotations [rad] and their rates [rad/s] (count, 2). Returns how many loads were clamped, or
 * -1 if the motion is no longer finite. */
SWAY_API int64_t sway_step_branches(sway_branch_block *blocks, size_t count, double *rotations,
                                    double *rates, double x, double y, double z,
                                    double drag_density);

/* The key rotations (count, 2) of branches of a stiffness [N m] (count) at rest in a wind, as near
 * as some turns come. The compliance of the blocks is 0. */
SWAY_API void sway_rest_branches(sway_branch_block *blocks, size_t count, double x, double y,
                                 double z, double drag_density, const double *stiffness,
                                 double *rotations);

/* Motion sensors: samples (9) are acceleration [m/s^2], angular rate [rad/s] and rotation [rad] in
 * the frame of the sensor, not a number where it does not measure; rows of a model (12) are the
 * acceleration, its part by tilted gravity, the rate and the rotation at the place of a sensor. */

enum { SWAY_RING = 4096 };

/* The last samples of a sensor. At first all is 0, but the time of the newest is minus infinity,
 * and the times and `before` are not a number. */
typedef struct sway_ring {
  double time[SWAY_RING];       /* [s] */
  double values[SWAY_RING][9];
  int64_t first, count;         /* row of the first sample, and their number */
  int64_t behind;               /* samples in a row far in the past */
  double newest;                /* time of the newest [s] */
  int64_t same[6];              /* how often each number was repeated */
  double before[6];             /* numbers of the sample before */
  int64_t given, lead; /* bits of the quantities of most samples, and the lead of these */
  int64_t still, spikes; /* samples in a row that repeat the one before, or are far from it */
  int64_t is_followed; /* whether the last sample was kept */
  double moved_at; /* time of the first one of those that repeat each other [s] */
  double offered[9], last[9]; /* the last sample, and the last one that was kept */
  double changes[3], noise[3]; /* running medians of the changes of quantities; least noise */
} sway_ring;

/* Results of `sway_keep_sample`: the sample was kept with the first two. */
enum {
  SWAY_KEPT,
  SWAY_CLOCK_BACK,
  SWAY_NOT_FINITE,
  SWAY_TOO_LARGE,
  SWAY_SATURATED,
  SWAY_OUT_OF_ORDER,
  SWAY_STUCK,
  SWAY_SPIKE,
  SWAY_OTHERS
};

/* Check a sample (9) of a time [s], and keep it, where the quantities of most samples are asked for.
 * If they are others from this sample on, it is not looked at: all samples are to be forgotten, and
 * it is to be offered again. */
SWAY_API int sway_keep_sample(sway_ring *ring, double time, const double *sample);

/* Forget all samples, and ask for quantities by their bits; the clock stays. */
SWAY_API void sway_ask_for(sway_ring *ring, int64_t given);

/* Read the motion about a time [s] into a sample (9), and forget older ones. Samples within a step
 * of dt [s] about the time are averaged; elsewhere those before and after are joined by a line.
 * Returns 0, and leaves zeros or a sum, where no sample is near. */
SWAY_API int sway_read_samples(sway_ring *ring, double time, double dt, double *sample);

/* Time between samples [s], the median of the last; not a number before two samples. */
SWAY_API double sway_sample_period(const sway_ring *ring);

enum { SWAY_HALVES = 3 };

/* Motions and forces in stretches that overlap by half, of which spectra are found. */
typedef struct sway_series {
  double *rows; /* a motion to east and north, n forces, another motion (SWAY_HALVES half, 4 + n),
                   written */
  int64_t half; /* rows of half a stretch */
  int64_t filled; /* rows since the last gap; the next one, modulo SWAY_HALVES half */
  int64_t first, second; /* numbers of the motions to east in a sample of a sensor */
} sway_series;

/* A sensor on a tree. */
typedef struct sway_sensor {
  sway_ring *ring;
  const double *mounting; /* rotation to the frame of the tree (9), factors of acceleration and
                               rate, gravity in the acceleration [m/s^2], and bias (9) */
  double *kept; /* memory of samples (rows, 9), written */
  double *computed; /* and of what the model says (rows, 12), written */
  double *moved; /* the last sample in the frame of the tree (9), written */
  sway_series *series; /* series of its motion; none where null */
  int64_t rows; /* of the memory */
  int64_t count; /* samples since its mounting is looked for; the next row, modulo rows */
  int64_t is_mounted; /* whether its mounting is known */
  int64_t is_awaited; /* whether its mounting is being found */
  int64_t in_use; /* whether its motion corrects the tree */
  int64_t is_refused; /* whether it disagrees with the tree */
  int64_t silences; /* times that it fell silent while it was in use */
  int64_t disagreements; /* times that it began to disagree */
  double dt; /* time of a step [s] */
  double absent; /* time without a sample about the step, and without a new one [s] */
  double unheard;
  double newest, apart; /* time of the newest sample, and that from the step, when it was absent */
  double excess; /* squared innovations over those expected, a running mean */
  double usual; /* that of the last minute of use, at least 1 */
  double agreed; /* time for which a refused sensor agrees [s] */
  double thrown; /* time for which each innovation is far beyond the usual ones [s] */
  double heard, came; /* time of the newest sample that was heard of, and of the step then */
  double lag; /* age of its newest sample before another comes, at its worst [s] */
} sway_sensor;

enum { SWAY_SLOTS = 64 };

/* The readings of k sensors on a model of m coordinates, and of the last steps what they would
 * measure by its motion in the wind alone. */
typedef struct sway_readings {
  int64_t sensors, coordinates, corrected; /* k, m; n, of which the air damping is known */
  int64_t late; /* steps by which sensors are read late */
  sway_sensor *const *sensor; /* (k) */
  const double *shapes; /* displacement and rotation of each sensor by coordinates (k, 6, m) */
  const double *stiffness; /* [1/s^2] (m) */
  const double *damping; /* by the wood [1/s] (m) */
  const double *air_damping; /* [1/s] (n) */
  const double *eta, *rate, *force; /* motion of the model (m) */
  double *sensed; /* (SWAY_SLOTS, k, 12), written */
  double *still; /* force on a tree that stands still (SWAY_SLOTS, n), written */
  double *beyond; /* what the last sample has beyond the model (k, 9), written */
  uint8_t *is_known; /* whether there is one, of a known mounting (k), written */
} sway_readings;

enum { SWAY_LATEST = 30 };

/* Compute what sensors would measure at the step `now`, whose end is at a time [s], and read them at
 * the step before it by which they are late, at most SWAY_LATEST. Returns that step, or -1 where no
 * sensor is read because it was done before. A sensor without a sample for longer than networks
 * delay one is no more in use. */
SWAY_API int64_t sway_read_sensors(sway_readings *readings, int64_t now, int64_t done, double time);

/* Judge a sensor by the mean square of its innovations over that expected: one whose innovations
 * stay far beyond those expected is refused until they are not. */
SWAY_API void sway_judge(sway_sensor *sensor, double size);

/* A steady filter of n coordinates by p measurements, three of each quantity. */
typedef struct sway_filter {
  int64_t coordinates, measurements; /* n, p */
  const double *law; /* state after a step by that before, of each coordinate (3, 3, n) */
  const double *sensed; /* measurements by the state (3 n, p) */
  const double *gain; /* correction of the state by the innovations (p, 3 n) */
  const double *deviation; /* of each innovation (p) */
  const int64_t *row; /* of each measurement among the readings, those of a sensor together (p) */
  double *state; /* displacement, rate and disturbance, as told (3, n) */
  double *calm; /* and calm (3, n) */
  double *innovations; /* of the last step, limited (p), written */
} sway_filter;

/* Move a filter by a number of steps, correct it by the readings of sensors that are known and in
 * use, and judge these. */
SWAY_API void sway_correct(const sway_filter *filter, const sway_readings *readings, size_t steps);

/* Correct a filter by measurements (steps, p), each a step after the one before, and add the squares
 * of its innovations (p). */
SWAY_API void sway_try(const sway_filter *filter, const double *measured, size_t steps,
                       double *squares);

/* A correction of n coordinates. */
typedef struct sway_correction {
  int64_t coordinates;
  const double *stiffness; /* [1/s^2] (n) */
  const double *wanted; /* trust of new gains (n) */
  double *trust; /* share of the correction that is applied (n), written */
  const double *leaning; /* share of its lean that is applied at most (n) */
  double *moved; /* displacement, rate and force of the correction (3, n), written */
  double *energies; /* of the motion with and without it, both twice (2), written */
} sway_correction;

/* Bring a calm motion (3, n) to the present by `ahead` (3, 3, n), as far as each coordinate of it
 * is trusted, where the trust goes a share of the way to that wanted. Its lean, force over
 * stiffness, is trusted as that of the most trusted one. The motion without correction has
 * displacements and rates (n). */
SWAY_API void sway_carry(const sway_correction *correction, const double *ahead, const double *calm,
                         double share, const double *eta, const double *rate);

/* What the correction of n coordinates moves of all m by drag and by its force. */
typedef struct sway_dragged {
  int64_t coordinates, corrected; /* m, n */
  const double
      *law; /* displacement and rate after a step by those before and the force (2, 3, m) */
  const double *drag; /* force on each coordinate per rate of the corrected ones (n, m) */
  const double *push; /* force on each coordinate per force of the corrected ones (n, m) */
  const double *trust; /* (n) */
  double *state; /* displacement, rate and force (3, m), written */
} sway_dragged;

/* Move it by a number of steps under a correction (3, n), and write it with the correction to
 * `added` (2, m). */
SWAY_API void sway_drag(const sway_dragged *dragged, const double *correction, size_t steps,
                        double *added);

/* The wind of the g parts of a crown apart from its anemometer, by k low-passes of it. */
typedef struct sway_farwind {
  int64_t parts, stages; /* g, k */
  int64_t directions, samples; /* of the mean wind, d; of a drawn field, s */
  int64_t is_sample; /* whether what is drawn is added */
  const double *length; /* of the low-passes [m] (k) */
  const double
      *weights; /* of the low-passes in winds from each direction, or all alike (d, g, k) */
  const double *share; /* of each part in the load (g) */
  const float *rest; /* what is drawn, over its deviations (s, g, 3); no matter where none is */
  double *memory; /* low-passes, mean, variance and what is told of it, (k + 3, 3); the run of the
                     wind [m], its time [s] and a number that is left alone (3), written */
  double *whole; /* wind of the crown (3), written */
} sway_farwind;

/* Add the wind x y z [m/s] of a step of dt [s] at the anemometer, and write the wind of each part
 * less that of the crown to `apart` (g, 3). */
SWAY_API void sway_push_farwind(const sway_farwind *wind, double x, double y, double z, double dt,
                                double *apart);

#ifdef __cplusplus
}
#endif

#endif
