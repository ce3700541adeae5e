// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "place_layout.h"

namespace {

using namespace sway;

// Largest deviation of a segment from a chord that it is taken to span, as a share of the chord.
constexpr double AS_ONE = 1e-12;

// Branches whose parents have slots: the richest and longest first, then children of the richest.
class Ready {
public:
  Ready(Memory &memory, const Arrays &a, const int64_t *carried)
      : a_(a), carried_(carried), heap_(memory.take<int64_t>(a.size[-SIZE_b])) {}

  bool is_there() const { return heap_ != nullptr; }
  int64_t count() const { return count_; }

  void add(int64_t branch) {
    int64_t at = count_++;
    for (; at > 0 && is_before(branch, heap_[(at - 1) / 2]); at = (at - 1) / 2)
      heap_[at] = heap_[(at - 1) / 2];
    heap_[at] = branch;
  }

  int64_t take() {
    const int64_t first = heap_[0], last = heap_[--count_];
    int64_t at = 0;
    for (int64_t next = 1; next < count_; next = 2 * at + 1) {
      if (next + 1 < count_ && is_before(heap_[next + 1], heap_[next])) next++;
      if (!is_before(heap_[next], last)) break;
      heap_[at] = heap_[next];
      at = next;
    }
    heap_[at] = last;
    return first;
  }

private:
  int64_t size(int64_t branch) const {
    return a_.branch_first[branch + 1] - a_.branch_first[branch];
  }

  bool is_before(int64_t one, int64_t other) const {
    const int64_t *keys = a_.branch_keys, *parent = a_.branch_parent;
    if (keys[one] != keys[other]) return keys[one] > keys[other];
    if (size(one) != size(other)) return size(one) > size(other);
    const int64_t below = keys[parent[one] < 0 ? 0 : parent[one]];
    const int64_t other_below = keys[parent[other] < 0 ? 0 : parent[other]];
    if (below != other_below) return below > other_below;
    if (carried_[one] != carried_[other]) return carried_[one] > carried_[other];
    return one < other;
  }

  const Arrays &a_;
  const int64_t *carried_;
  int64_t *heap_;
  int64_t count_ = 0;
};

// Block, slot and first record of every branch.
struct Slots {
  int64_t *block, *slot, *record;
  int64_t n_blocks = 0, n_records = 0;
};

bool assign_slots(Memory &memory, const Arrays &a, Slots &slots) {
  const int64_t b = a.size[-SIZE_b];
  slots.block = memory.take<int64_t>(b);
  slots.slot = memory.take<int64_t>(b);
  slots.record = memory.take<int64_t>(b);
  int64_t *carried = memory.take<int64_t>(b);
  int64_t *first_child = memory.take<int64_t>(b);
  int64_t *sibling = memory.take<int64_t>(b);
  Ready ready(memory, a, carried);
  if (memory.is_short) return false;
  for (int64_t i = 0; i < b; i++) carried[i] = 1, first_child[i] = sibling[i] = -1;
  for (int64_t i = b - 1; i > 0; i--) {
    const int64_t parent = a.branch_parent[i];
    carried[parent] += carried[i];
    sibling[i] = first_child[parent];
    first_child[parent] = i;
  }
  ready.add(0);
  while (ready.count() > 0) {
    int64_t together[WIDTH];
    int count = 0;
    while (count < WIDTH && ready.count() > 0) {
      const int64_t branch = ready.take();
      const int64_t size = a.branch_first[branch + 1] - a.branch_first[branch];
      // The longest first, as records have segments of the first slots only.
      int at = count++;
      for (; at > 0; at--) {
        const int64_t before = together[at - 1];
        if (a.branch_first[before + 1] - a.branch_first[before] >= size) break;
        together[at] = before;
      }
      together[at] = branch;
    }
    for (int at = 0; at < count; at++) {
      const int64_t branch = together[at];
      slots.block[branch] = slots.n_blocks;
      slots.slot[branch] = at;
      slots.record[branch] = slots.n_records;
      for (int64_t child = first_child[branch]; child >= 0; child = sibling[child])
        ready.add(child);
    }
    slots.n_blocks++;
    slots.n_records += a.branch_first[together[0] + 1] - a.branch_first[together[0]];
  }
  return true;
}

void rotate_back(const double q[4], const double v[3], double out[3]) {
  const double w = q[0], x = -q[1], y = -q[2], z = -q[3];
  const double tx = 2.0 * (y * v[2] - z * v[1]);
  const double ty = 2.0 * (z * v[0] - x * v[2]);
  const double tz = 2.0 * (x * v[1] - y * v[0]);
  out[0] = v[0] + w * tx + y * tz - z * ty;
  out[1] = v[1] + w * ty + z * tx - x * tz;
  out[2] = v[2] + w * tz + x * ty - y * tx;
}

double square(const double v[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

// Whether a vector is along the x axis.
bool is_along(const double v[3]) {
  return __builtin_sqrt(v[1] * v[1] + v[2] * v[2]) <= AS_ONE * v[0];
}

// Write one segment of a branch; returns whether its chord is its x axis.
bool fill_segment(const Arrays &a, int64_t number, Segment &record, int64_t slot) {
  const int64_t k = a.size[-SIZE_k];
  double chord[3];
  rotate_back(a.segment_rest + 4 * number, a.segment_chord + 3 * number, chord);
  record.slope[slot] = a.segment_slope[number];
  record.tip_slope[slot] = a.segment_tip_slope[number] - a.segment_slope[number];
  for (int axis = 0; axis < 3; axis++) record.chord[axis][slot] = chord[axis];
  for (int axis = 0; axis < 4; axis++) record.rest[axis][slot] = a.segment_rest[4 * number + axis];
  for (int64_t row = 0; row < k && record.turn; row++)
    for (int axis = 0; axis < 3; axis++)
      record.turn[(3 * row + axis) * WIDTH + slot] = a.segment_turn[(number * k + row) * 3 + axis];
  if (slot >= record.n_slots) record.n_slots = slot + 1;
  return is_along(chord);
}

void fill_branch(const Arrays &a, int64_t branch, Block &block, int64_t slot) {
  const int64_t k = a.size[-SIZE_k], parent = a.branch_parent[branch];
  const int64_t below = parent < 0 ? 0 : parent;
  block.branch[slot] = branch;
  block.parent[slot] = parent;
  block.coordinate[slot] = a.branch_coordinate[branch];
  block.parent_coordinate[slot] = a.branch_coordinate[below];
  block.base_segment[slot] = a.branch_base_segment[branch];
  block.first[slot] = a.branch_first[branch];
  block.skew[slot] = a.branch_skew[2 * branch];
  block.tip_skew[slot] = a.branch_skew[2 * branch + 1] - a.branch_skew[2 * branch];
  block.bound_factor[slot] = static_cast<double>(a.branch_keys[branch] - 1);
  for (int axis = 0; axis < 3; axis++) {
    block.axes[0][axis][slot] = a.branch_frame[9 * branch + 3 + axis];
    block.axes[1][axis][slot] = a.branch_frame[9 * branch + 6 + axis];
    block.offset[axis][slot] = a.branch_offset[3 * branch + axis];
  }
  for (int64_t row = 0; row < k; row++)
    for (int axis = 0; axis < 3; axis++)
      block.base_rotation[(3 * row + axis) * WIDTH + slot] =
          a.branch_twist[(branch * k + row) * 6 + 3 + axis];
  for (int64_t i = a.branch_first[branch]; i < a.branch_first[branch + 1]; i++)
    for (int64_t row = 0; row < k; row++) {
      double &steepest = block.steepest[row * WIDTH + slot];
      double turn = square(a.segment_turn + (i * k + row) * 3);
      const double tip = a.segment_tip_slope[i] * a.segment_tip_slope[i];
      if (row == 0 && tip > turn) turn = tip;
      if (turn > steepest) steepest = turn;
    }
  const double *offset = a.branch_offset + 3 * branch;
  const bool is_aside = __builtin_fabs(offset[1]) > AS_ONE * offset[0] ||
                        __builtin_fabs(offset[2]) > AS_ONE * offset[0];
  if (is_aside) block.is_at_axes = 0;
  if (slot >= block.n_slots) block.n_slots = slot + 1;
  if (a.branch_keys[branch] > block.n_rows) block.n_rows = a.branch_keys[branch];
  if (parent >= 0 && a.branch_keys[below] > block.n_parent_rows)
    block.n_parent_rows = a.branch_keys[below];
}

}  // namespace

namespace sway {

void lay_out_places(sway_model &model, const Arrays &a) {
  Memory scratch;
  Slots slots;
  const int64_t k = a.size[-SIZE_k];
  if (!assign_slots(scratch, a, slots)) {
    model.memory.is_short = true;
    scratch.release();
    return;
  }
  Block *blocks = model.memory.take<Block>(slots.n_blocks);
  Segment *segments = model.memory.take<Segment>(slots.n_records);
  double *by_block = model.memory.take<double>(slots.n_blocks * 4 * k * WIDTH);
  double *turns = k > 2 ? model.memory.take<double>(slots.n_records * 3 * k * WIDTH) : nullptr;
  if (!model.memory.is_short) {
    for (int64_t i = 0; i < slots.n_blocks; i++) {
      blocks[i].base_rotation = by_block + i * 4 * k * WIDTH;
      blocks[i].steepest = blocks[i].base_rotation + 3 * k * WIDTH;
      blocks[i].is_joined = blocks[i].is_at_axes = 1;
      blocks[i].n_rows = blocks[i].n_parent_rows = 2;
    }
    for (int64_t i = 0; i < slots.n_records; i++) {
      for (int slot = 0; slot < WIDTH; slot++) segments[i].rest[0][slot] = 1.0;
      if (turns) segments[i].turn = turns + i * 3 * k * WIDTH;
    }
    for (int64_t branch = 0; branch < a.size[-SIZE_b]; branch++) {
      Block &block = blocks[slots.block[branch]];
      const int64_t slot = slots.slot[branch], record = slots.record[branch];
      const int64_t first = a.branch_first[branch], end = a.branch_first[branch + 1];
      block.first_record = record;
      if (end - first > block.n_records) block.n_records = end - first;
      fill_branch(a, branch, block, slot);
      for (int64_t i = first; i < end; i++)
        if (!fill_segment(a, i, segments[record + i - first], slot)) block.is_joined = 0;
      if (branch == 0) continue;
      Block &below = blocks[slots.block[a.branch_parent[branch]]];
      const int64_t seat = slots.slot[a.branch_parent[branch]] + 1;
      if (seat > below.n_parents) below.n_parents = seat;
    }
  }
  model.n_blocks = slots.n_blocks;
  model.blocks = blocks;
  model.segments = segments;
  scratch.release();
}

}  // namespace sway
