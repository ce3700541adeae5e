// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What the page calls beside sway.h, in WebAssembly alone: placing by streamed coordinates, the
// coefficients of a step, and the memory that a module without a run-time library has.
#include "propagate.h"
#include "sway.h"

using namespace sway;

namespace {

// Memory of one of some sizes, which begins with this; `next` counts where it is free.
struct alignas(16) Head {
  Head *next;
  uint32_t kind;
};

Head *first_free[128];  // by kind

constexpr uint64_t PAGE = 65536;

// The end of the memory that was given, as the browser counts it.
uint64_t given = 0;

// Memory of the browser beyond that; null if it has none. Its last page stays out, as its end is
// address 0.
Head *grow(uint64_t size) {
  const uint64_t pages = __builtin_wasm_memory_size(0), from = given ? given : PAGE * pages;
  const uint64_t end = from + size, needed = (end + PAGE - 1) / PAGE;
  if (end > SIZE_MAX - PAGE) return nullptr;
  if (needed > pages && __builtin_wasm_memory_grow(0, needed - pages) == SIZE_MAX) return nullptr;
  given = end;
  return reinterpret_cast<Head *>(from);
}

}  // namespace

// A model that is placed by coordinates.
struct page_placer {
  Memory memory;
  const sway_model *model;
  Room room;
  State state;
};

extern "C" {

void *calloc(size_t count, size_t each) {
  size_t size;
  if (__builtin_mul_overflow(count, each, &size) || size > SIZE_MAX - sizeof(Head)) return nullptr;
  // Five to eight times a power of two, or less of sixteen bytes.
  uint32_t power = 4;
  while ((size + sizeof(Head) - 1) >> power >= 8) power++;
  const uint32_t times = ((size + sizeof(Head) - 1) >> power) + 1, kind = 4 * power + times - 5;
  Head *own = first_free[kind];
  if (own)
    first_free[kind] = own->next;
  else
    own = grow(uint64_t(times) << power);
  if (!own) return nullptr;
  own->kind = kind;
  return memset(own + 1, 0, size);
}

void free(void *memory) {
  if (!memory) return;
  Head *own = static_cast<Head *>(memory) - 1;
  own->next = first_free[own->kind];
  first_free[own->kind] = own;
}

// Make a placer of a model, which must outlive it; null where memory is short.
SWAY_API page_placer *page_placer_open(const sway_model *model) {
  page_placer *placer = static_cast<page_placer *>(calloc(1, sizeof(page_placer)));
  if (!placer) return nullptr;
  placer->model = model;
  Memory &memory = placer->memory;
  open_room(memory, &model, 1, placer->room);
  memory.take(model->padded + 1, placer->state.eta, placer->state.hidden, placer->state.left_out);
  if (!memory.is_short) return placer;
  memory.release();
  free(placer);
  return nullptr;
}

SWAY_API void page_placer_close(page_placer *placer) {
  placer->memory.release();
  free(placer);
}

// Place a tree by its streamed coordinates (m), at x, y, z [m], turned by `yaw` [rad] about the
// vertical and `scale` as large. `turns` (count, 2) has key rotations and what is added to them
// [rad]. A row of `out` (n, 8) is x y z, the scale, and the quaternion x y z w.
SWAY_API void page_place(page_placer *placer, const float *coordinates, double x, double y,
                         double z, double yaw, double scale, const double *turns, size_t count,
                         float *out) {
  const sway_model &model = *placer->model;
  Room &room = placer->room;
  const Frame &frame = frame_of_machine();
  for (int64_t i = 0; i < model.sizes.coordinates; i++)
    placer->state.eta[i] = double(coordinates[i]);
  frame.find_keys(model, placer->state, room);
  for (size_t i = 0; i < count; i++)
    room.keys[count_of(turns[2 * i], model.sizes.keys - 1)] += turns[2 * i + 1];
  const Place place = {__builtin_cos(0.5 * yaw), __builtin_sin(0.5 * yaw), scale, {x, y, z}};
  Late none = {};
  frame.place(model, place, room, *room.poses, none);
  const double *pose = *room.poses;
  for (int64_t i = 0; i < model.sizes.segments; i++, pose += 7, out += 8) {
    for (int axis = 0; axis < 3; axis++) out[axis] = float(pose[axis]);
    out[3] = float(scale);
    for (int part = 0; part < 4; part++) out[4 + part] = float(pose[3 + part]);
  }
}

// Write the coefficients of a step of `dt` [s] of a model, and of half of it to where the load is
// found: rows of `padded` numbers (6, padded), as `Step` has them. Returns `padded`.
SWAY_API size_t page_steps(const sway_model *model, double dt, double *whole, double *half) {
  if (whole)
    fill_step(model->sizes.coordinates, model->padded, model->stiffness, model->own_damping, dt,
              {whole, half, dt});
  return size_t(model->padded);
}
}
