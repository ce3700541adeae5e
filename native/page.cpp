// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What the page calls beside sway.h, in WebAssembly alone: placing by streamed coordinates, the
// coefficients of a step, and the memory that a module without a run-time library has.
#include "propagate.h"
#include "sway.h"

using namespace sway;

namespace {

// Memory that is free, in the order of its addresses. Every block begins with such a head, of which
// `next` counts where it is free.
struct alignas(16) Free {
  size_t size;  // with the head
  Free *next;
};

Free *first_free = nullptr;

constexpr size_t PAGE = 65536;

char *end_of(Free *block) { return reinterpret_cast<char *>(block) + block->size; }

// Join a free block with one that begins where it ends.
void join(Free *block) {
  if (!block || !block->next || end_of(block) != reinterpret_cast<char *>(block->next)) return;
  block->size += block->next->size;
  block->next = block->next->next;
}

void put_back(Free *block) {
  Free *before = nullptr;
  Free **at = &first_free;
  for (; *at && *at < block; at = &(*at)->next) before = *at;
  block->next = *at;
  *at = block;
  join(block);
  join(before);
}

// Add memory of the browser; false if it has none.
bool grow(size_t size) {
  const size_t pages = size / PAGE + 1;
  const size_t before = __builtin_wasm_memory_grow(0, pages);
  if (before == SIZE_MAX) return false;
  Free *block = reinterpret_cast<Free *>(before * PAGE);
  // The last page of 4 GiB stays out, as its end is address 0.
  block->size = pages * PAGE - (before + pages == SIZE_MAX / PAGE + 1 ? PAGE : 0);
  if (block->size) put_back(block);
  return true;
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
  if (__builtin_mul_overflow(count, each, &size) || size > SIZE_MAX - 2 * sizeof(Free))
    return nullptr;
  size = (size + 2 * sizeof(Free) - 1) / sizeof(Free) * sizeof(Free);
  do {
    for (Free **at = &first_free; *at; at = &(*at)->next) {
      Free *block = *at;
      if (block->size < size) continue;
      if (block->size - size < 2 * sizeof(Free)) {
        *at = block->next;
      } else {
        Free *rest = reinterpret_cast<Free *>(reinterpret_cast<char *>(block) + size);
        *rest = {block->size - size, block->next};
        *at = rest;
        block->size = size;
      }
      return memset(block + 1, 0, block->size - sizeof(Free));
    }
  } while (grow(size));
  return nullptr;
}

void free(void *memory) {
  if (memory) put_back(static_cast<Free *>(memory) - 1);
}

int strncmp(const char *one, const char *other, size_t size) {
  for (; size && *one && *one == *other; size--) one++, other++;
  return size ? *one - *other : 0;
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
