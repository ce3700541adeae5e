// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Trees at their places: their states, their steps and the order of work of a frame.
#include <math.h>

#include "gusts.h"
#include "library.h"
#include "propagate.h"
#include "text.h"
#include "threads.h"

using namespace sway;

namespace {

// Largest relative difference of scales of trees that have the same time step.
constexpr double FINEST_SCALE = 0.01;

// Segments whose poses are more than caches hold.
constexpr int64_t BEYOND_CACHES = 100000;

struct Tree {
  int64_t model, step;  // numbers of its model and its step
  Place place;
  double speed;  // wind at its height over that at the height of its model
};

// A length of steps of the trees of a model and, to `FINEST_SCALE`, of a scale.
struct OwnStep {
  int64_t model;
  double scale;
  Step step;
};

// A model in a stand, as it is tuned.
struct Kind {
  const sway_model *model;
  Tuning tuning;
};

}  // namespace

struct sway_stand {
  Memory memory;
  const Frame *frame;
  size_t n_trees, n_models, n_rooms, n_steps;
  Tree *trees;
  const Tree **order;  // of steps: neighbours read the same rows of a table
  Kind *kinds;
  OwnStep *steps;
  Room *rooms;
  Threads *threads;  // null on a page
  LimpTree *limp;  // of each tree; null without limp ones
  double *states;
  size_t stride, width;
  bool has_crowns;
  bool is_large;  // beyond the caches
};

namespace {

// Numbers of a state beside its rows: wind, drag density, clamped, left out, at rest, one spare.
constexpr size_t ROWS = 6, SCALARS = 8;

State state_of(const sway_stand &stand, size_t tree) {
  double *first = stand.states + tree * stand.stride;
  const size_t width = stand.width;
  double *scalars = first + ROWS * width;
  const sway_model &model = *stand.kinds[stand.trees[tree].model].model;
  double *crown = model.sizes.delays ? scalars + SCALARS : nullptr;
  return {first,
          first + width,
          first + 2 * width,
          first + 3 * width,
          first + 4 * width,
          first + 5 * width,
          scalars,
          scalars + 3,
          scalars + 4,
          scalars + 5,
          scalars + 6,
          crown};
}

// Bring the state of a tree near while another one is at work.
void fetch_state(const sway_stand &stand, size_t tree) {
  const double *first = stand.states + tree * stand.stride;
  for (size_t i = 0; i < ROWS * stand.width + SCALARS; i += 8) __builtin_prefetch(first + i);
}

bool is_tree(const sway_tree &tree, size_t n_models) {
  const double numbers[] = {tree.at[0], tree.at[1], tree.at[2], tree.yaw, tree.scale, tree.speed};
  for (double number : numbers)
    if (!isfinite(number)) return false;
  return tree.scale > 0.0 && tree.speed >= 0.0 && tree.model >= 0 && size_t(tree.model) < n_models;
}

// The number of the step of a tree, added if no tree before it has the same.
int64_t step_of(sway_stand &stand, const sway_tree &tree) {
  const double scale = exp(FINEST_SCALE * rint(log(tree.scale) / FINEST_SCALE));
  for (size_t i = 0; i < stand.n_steps; i++)
    if (stand.steps[i].model == tree.model && stand.steps[i].scale == scale) return int64_t(i);
  OwnStep &own = stand.steps[stand.n_steps];
  own = {tree.model, scale, {}};
  stand.memory.take(6 * stand.kinds[tree.model].model->padded, own.step.whole, own.step.half);
  return int64_t(stand.n_steps++);
}

// Take what a limp tree has beside its state.
void open_limp(Memory &memory, const sway_model &model, LimpTree &tree) {
  const int64_t m = model.sizes.coordinates, row = model.limp.row, padded = model.padded;
  memory.take(m * model.limp.places, tree.columns);
  memory.take(model.limp.leading * row, tree.change);
  memory.take(row, tree.weight);
  memory.take(padded, tree.last_eta, tree.last_rate);
  for (CoupledStep &law : tree.laws) {
    memory.take(6 * padded, law.part.whole, law.part.half);
    memory.take(row, law.coupled, law.stretch, law.per_force, law.own, law.root_damping);
    memory.take(padded, law.own_damping);
  }
}

void open_kind(sway_stand &stand, Kind &kind, const sway_model *model) {
  kind.model = model;
  Tuning &tuning = kind.tuning;
  stand.memory.take(model->padded, tuning.stiffness, tuning.damping);
  if (!model->sizes.is_stepped || stand.memory.is_short) return;
  memcpy(tuning.stiffness, model->stiffness, model->padded * sizeof(double));
  memcpy(tuning.damping, model->own_damping, model->padded * sizeof(double));
}

bool is_before(const Tree &one, const Tree &other) {
  return one.model != other.model ? one.model < other.model : one.place.cosine < other.place.cosine;
}

// Put the trees of a stand in order, over narrower and narrower gaps (Shell 1959, Communications of the
// ACM 2, 30-32) that have no divisor in common with the next (Knuth 1973, The Art of Computer Programming
// 3, 5.2.1): trees of four kinds in turns would else be left to the last.
void sort_trees(sway_stand &stand) {
  const Tree **order = stand.order;
  size_t gap = 1;
  while (gap < stand.n_trees / 3) gap = 3 * gap + 1;
  for (; gap > 0; gap /= 3)
    for (size_t i = gap; i < stand.n_trees; i++) {
      const Tree *own = order[i];
      size_t at = i;
      for (; at >= gap && is_before(*own, *order[at - gap]); at -= gap) order[at] = order[at - gap];
      order[at] = own;
    }
}

bool open(sway_stand &stand, const sway_model *const *models, const sway_tree *trees) {
  Memory &memory = stand.memory;
  memory.take(stand.n_models, stand.kinds);
  memory.take(stand.n_rooms, stand.rooms);
  memory.take(stand.n_trees, stand.trees, stand.steps, stand.order);
  if (stand.memory.is_short) return false;
  for (size_t i = 0; i < stand.n_models; i++) {
    open_kind(stand, stand.kinds[i], models[i]);
    const size_t width = size_t(models[i]->padded);
    if (width > stand.width) stand.width = width;
  }
  stand.stride = ROWS * stand.width + SCALARS;
  for (size_t i = 0; i < stand.n_models; i++)
    if (models[i]->sizes.delays && !stand.has_crowns) {
      stand.has_crowns = true;
      stand.stride += CROWN + 1;  // an even number
    }
  memory.take(uint64_t(stand.n_trees) * stand.stride, stand.states);
  for (size_t i = 0; i < stand.n_rooms; i++)
    open_room(stand.memory, models, stand.n_models, stand.rooms[i]);
  for (size_t i = 0; i < stand.n_models; i++)
    if (is_limp(*models[i]) && !stand.limp) memory.take(stand.n_trees, stand.limp);
  int64_t n_segments = 0;
  for (size_t i = 0; i < stand.n_trees && !stand.memory.is_short; i++) {
    const sway_tree &given = trees[i];
    n_segments += models[given.model]->sizes.segments;
    Tree &tree = stand.trees[i];
    stand.order[i] = &tree;
    tree.model = given.model;
    tree.speed = given.speed;
    tree.place = {cos(0.5 * given.yaw),
                  sin(0.5 * given.yaw),
                  given.scale,
                  {given.at[0], given.at[1], given.at[2]}};
    tree.step = step_of(stand, given);
    if (stand.limp && is_limp(*models[given.model]))
      open_limp(stand.memory, *models[given.model], stand.limp[i]);
  }
  if (!ON_TABLES && stand.n_rooms > 1) stand.threads = open_threads(stand.memory, stand.n_rooms);
  stand.is_large = n_segments > BEYOND_CACHES;
  if (stand.memory.is_short) return false;
  sort_trees(stand);
  return true;
}

// The wind at the height of a tree, in the frame of its model; calm if it is not below `STRONGEST`.
void wind_in_frame(const Tree &tree, const double *wind, double out[3]) {
  const double cosine = tree.place.cosine * tree.place.cosine - tree.place.sine * tree.place.sine;
  const double sine = 2.0 * tree.place.cosine * tree.place.sine;
  out[0] = tree.speed * (cosine * wind[0] + sine * wind[1]);
  out[1] = tree.speed * (cosine * wind[1] - sine * wind[0]);
  out[2] = tree.speed * wind[2];
  bool is_wind = true;
  for (int axis = 0; axis < 3; axis++) is_wind &= fabs(out[axis]) < STRONGEST;
  for (int axis = 0; axis < 3 && !is_wind; axis++) out[axis] = 0.0;
}

bool is_finite(const State &state, int64_t count) {
  double found = 0.0;  // a difference of equal numbers is 0 unless they are not finite
  for (int64_t i = 0; i < count; i++)
    found += (state.eta[i] - state.eta[i]) + (state.rate[i] - state.rate[i]);
  return found == 0.0;
}

void come_to_rest(const State &state, int64_t count) {
  for (int64_t i = 0; i < count; i++) state.eta[i] = state.rate[i] = state.force[i] = 0.0;
}

// Trees from a number on that are stepped, and how many were clamped and went on from rest.
struct Steps {
  sway_stand *stand;
  size_t first;
  bool is_all;  // in any order
  const double *winds;
  int64_t counts[2];
};

void step_part(void *work, size_t room, size_t from, size_t count) {
  Steps &steps = *static_cast<Steps *>(work);
  sway_stand *stand = steps.stand;
  int64_t n_clamped = 0, n_restarted = 0;
  const auto number_of = [&](size_t i) {
    return steps.is_all ? size_t(stand->order[i] - stand->trees) : steps.first + i;
  };
  for (size_t i = from; i < from + count; i++) {
    const size_t number = number_of(i);
    if (i + 1 < from + count) fetch_state(*stand, number_of(i + 1));
    const Tree &tree = stand->trees[number];
    const Kind &kind = stand->kinds[tree.model];
    const sway_model &model = *kind.model;
    if (!model.sizes.is_stepped) continue;
    State state = state_of(*stand, number);
    double wind[3];
    wind_in_frame(tree, steps.winds + 3 * (number - steps.first), wind);
    const Step &step = stand->steps[tree.step].step;
    Room &own = stand->rooms[room];
    const Frame &frame = *stand->frame;
    bool is_sound = true;
    // A tree of which coordinates are left out is stepped by its table, if it has one.
    if (is_limp(model) && (!model.table.levels || !(*state.left_out > 0.0))) {
      LimpTree &limp = stand->limp[number];
      n_clamped += frame.step_at_pose(model, kind.tuning, step, state, limp, own, wind);
      is_sound = isfinite(limp.allowed);
    } else {
      n_clamped += frame.step(model, kind.tuning.stiffness, step, state, own, wind);
    }
    if (is_sound && is_finite(state, model.padded)) continue;
    come_to_rest(state, model.padded);
    n_restarted++;
  }
  __atomic_fetch_add(&steps.counts[0], n_clamped, __ATOMIC_RELAXED);
  __atomic_fetch_add(&steps.counts[1], n_restarted, __ATOMIC_RELAXED);
}

struct Places {
  sway_stand *stand;
  const int64_t *rows;
  double *poses;
};

void place_part(void *work, size_t room, size_t from, size_t count) {
  const Places &places = *static_cast<Places *>(work);
  const sway_stand *stand = places.stand;
  Room &own = stand->rooms[room];
  const bool is_large = PASSES_CACHES && stand->is_large;
  const int64_t *row = places.rows + 2 * from, *end = row + 2 * count;
  Late late = {};
  for (int number = 0; row < end; row += 2, number ^= 1) {
    const Tree &tree = stand->trees[row[0]];
    const sway_model &model = *stand->kinds[tree.model].model;
    stand->frame->find_keys(model, state_of(*stand, row[0]), own);
    double *out = places.poses + 7 * row[1];
    // The last is written where it goes, as none is placed after it.
    const bool is_late = is_large && row + 2 < end;
    if (is_late) fetch_state(*stand, row[2]);
    stand->frame->place(model, tree.place, own, is_late ? own.poses[number] : out, late);
    if (is_late) late.begin(own.poses[number], 7 * model.sizes.segments, out);
  }
  if (is_large) end_of_writes();
}

// Do work in a room, or by all threads in theirs.
void do_parts(const sway_stand &stand, size_t room, size_t count, Part part, void *work) {
  if (ON_TABLES || room != SWAY_EVERY_ROOM)
    part(work, room, 0, count);
  else if (stand.threads)
    share(*stand.threads, count, part, work);
  else
    part(work, 0, 0, count);
}

// Number of trees times segments of the largest beyond which a stand has several threads, and the
// number of them beyond which memory is the limit.
constexpr int64_t LARGE = 100000, MOST_THREADS = 8;

size_t rooms_for(const sway_model *const *models, size_t n_models, size_t n_trees) {
  int64_t largest = 0;
  for (size_t i = 0; i < n_models; i++) raise_to(largest, models[i]->sizes.segments);
  if (ON_TABLES || largest * int64_t(n_trees) <= LARGE) return 1;
  const size_t granted = processors();
  return granted < MOST_THREADS ? granted : MOST_THREADS;
}

}  // namespace

extern "C" {

sway_stand *sway_stand_open(const sway_model *const *models, size_t n_models,
                            const sway_tree *trees, size_t n_trees, size_t rooms, char *error,
                            size_t room) {
  Text text(error, room);
  for (size_t i = 0; i < n_trees; i++)
    if (!is_tree(trees[i], n_models)) {
      text.add("a tree whose numbers are not finite, or whose model does not exist");
      return nullptr;
    }
  sway_stand *stand = static_cast<sway_stand *>(calloc(1, sizeof(sway_stand)));
  if (stand) {
    stand->frame = &frame_of_machine();
    stand->n_models = n_models;
    stand->n_trees = n_trees;
    stand->n_rooms = rooms ? rooms : rooms_for(models, n_models, n_trees);
    if (open(*stand, models, trees)) return stand;
  }
  sway_stand_close(stand);
  text.add("memory is short");
  return nullptr;
}

void sway_stand_close(sway_stand *stand) {
  if (!stand) return;
  if (!ON_TABLES) close_threads(stand->threads);
  stand->memory.release();
  free(stand);
}

double *sway_state(sway_stand *stand, size_t *stride, size_t *width) {
  *stride = stand->stride;
  *width = stand->width;
  return stand->states;
}

int sway_tune(sway_stand *stand, size_t model, const double *stiffness, const double *damping) {
  if (model >= stand->n_models) return -1;
  Kind &kind = stand->kinds[model];
  const int64_t m = kind.model->sizes.coordinates;
  for (int64_t i = 0; i < m; i++)
    if (!(stiffness[i] >= 0.0 && damping[i] >= 0.0 && isfinite(stiffness[i] + damping[i])))
      return -1;
  Tuning &tuning = kind.tuning;
  if (memcmp(tuning.stiffness, stiffness, m * sizeof(double)) != 0) tuning.n_tuned++;
  memcpy(tuning.stiffness, stiffness, m * sizeof(double));
  memcpy(tuning.damping, damping, m * sizeof(double));
  return 0;
}

int sway_set_step(sway_stand *stand, double dt) {
  if (!(dt > 0.0 && isfinite(dt))) return -1;
  for (size_t i = 0; i < stand->n_steps; i++) {
    OwnStep &own = stand->steps[i];
    own.step.dt = dt / own.scale;
    const Kind &kind = stand->kinds[own.model];
    const sway_model &model = *kind.model;
    if (model.sizes.is_stepped)
      fill_step(model.sizes.coordinates, model.padded, kind.tuning.stiffness, kind.tuning.damping,
                own.step.dt, own.step);
  }
  for (size_t i = 0; i < stand->n_models; i++) stand->kinds[i].tuning.n_set++;
  return 0;
}

int sway_step(sway_stand *stand, size_t room, size_t first, size_t count, const double *winds,
              int64_t counts[2]) {
  Steps steps = {stand, first, count == stand->n_trees, winds, {}};
  do_parts(*stand, room, count, step_part, &steps);
  if (counts) memcpy(counts, steps.counts, sizeof(steps.counts));
  return (steps.counts[0] ? SWAY_CLAMPED : SWAY_OK) | (steps.counts[1] ? SWAY_RESTARTED : SWAY_OK);
}

void sway_place(sway_stand *stand, size_t room, const int64_t *rows, size_t count, double *poses) {
  Places places = {stand, rows, poses};
  do_parts(*stand, room, count, place_part, &places);
}

int sway_step_first(const sway_first *first) {
  return sway_step(first->stand, 0, 0, 1, first->wind, nullptr);
}

void sway_place_first(const sway_first *first) {
  const int64_t row[2] = {};
  sway_place(first->stand, 0, row, 1, first->poses);
}

void sway_keys(sway_stand *stand, size_t room, size_t tree, double *keys) {
  const sway_model &model = *stand->kinds[stand->trees[tree].model].model;
  stand->frame->find_keys(model, state_of(*stand, tree), stand->rooms[room]);
  memcpy(keys, stand->rooms[room].keys, model.sizes.keys * sizeof(double));
}

void sway_place_keys(sway_stand *stand, size_t room, size_t tree, const double *keys,
                     double *poses) {
  const Tree &own = stand->trees[tree];
  const sway_model &model = *stand->kinds[own.model].model;
  memcpy(stand->rooms[room].keys, keys, model.sizes.keys * sizeof(double));
  Late none = {};
  stand->frame->place(model, own.place, stand->rooms[room], poses, none);
}
}
