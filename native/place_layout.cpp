// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
#include "place_layout.h"

#include "turn.h"

namespace {

using namespace sway;

// Largest deviation of a segment from a chord that it is taken to span, as a share of the chord.
constexpr double AS_ONE = 1e-12;

int64_t size_of(const Arrays &a, int64_t branch) {
  return a.branch_first[branch + 1] - a.branch_first[branch];
}

// Branches whose parents have slots: the richest and longest first, then children of the richest.
class Ready {
public:
  Ready(Memory &memory, const Arrays &a, const int64_t *carried) : a_(a), carried_(carried) {
    memory.take(a.size[-SIZE_b], heap_);
  }

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
  bool is_before(int64_t one, int64_t other) const {
    const int64_t *keys = a_.branch_keys, *parent = a_.branch_parent;
    if (keys[one] != keys[other]) return keys[one] > keys[other];
    const int64_t size = size_of(a_, one), other_size = size_of(a_, other);
    if (size != other_size) return size > other_size;
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
  int64_t *carried, *first_child, *sibling;
  memory.take(b, slots.block, slots.slot, slots.record, carried, first_child, sibling);
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
      // The longest first, as records have segments of the first slots only.
      int at = count++;
      for (; at > 0 && size_of(a, together[at - 1]) < size_of(a, branch); at--)
        together[at] = together[at - 1];
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
    slots.n_records += size_of(a, together[0]);
  }
  return true;
}

// Whether a vector is along the x axis.
bool is_along(const Vector<double> &v) {
  return __builtin_sqrt(v.y * v.y + v.z * v.z) <= AS_ONE * v.x;
}

// Write numbers to a slot of rows.
void put(double *rows, int64_t slot, const double *numbers, int64_t count) {
  for (int64_t row = 0; row < count; row++) rows[row * WIDTH + slot] = numbers[row];
}

// Write one segment of a branch; returns whether its chord is its x axis.
bool fill_segment(const Arrays &a, int64_t number, Segment &record, int64_t slot) {
  const int64_t k = a.size[-SIZE_k];
  const double *rest = a.segment_rest + 4 * number;
  const Vector<double> chord =
      rotated({rest[0], -rest[1], -rest[2], -rest[3]}, read(a.segment_chord + 3 * number));
  record.slope[slot] = a.segment_slope[number];
  record.tip_slope[slot] = a.segment_tip_slope[number] - a.segment_slope[number];
  put(*record.chord, slot, &chord.x, 3);
  put(*record.rest, slot, rest, 4);
  if (record.turn) put(record.turn, slot, a.segment_turn + 3 * k * number, 3 * k);
  raise_to(record.n_slots, slot + 1);
  return is_along(chord);
}

void fill_branch(const Arrays &a, int64_t branch, Block &block, int64_t slot) {
  const int64_t k = a.size[-SIZE_k], parent = a.branch_parent[branch];
  const int64_t below = parent < 0 ? 0 : parent;
  const double *frame = a.branch_frame + 9 * branch, *skew = a.branch_skew + 2 * branch;
  const double *offset = a.branch_offset + 3 * branch;
  block.branch[slot] = branch;
  block.parent[slot] = parent;
  block.coordinate[slot] = a.branch_coordinate[branch];
  block.parent_coordinate[slot] = a.branch_coordinate[below];
  block.base_segment[slot] = a.branch_base_segment[branch];
  block.first[slot] = a.branch_first[branch];
  block.skew[slot] = skew[0];
  block.tip_skew[slot] = skew[1] - skew[0];
  block.bound_factor[slot] = double(a.branch_keys[branch] - 1);
  put(**block.axes, slot, frame + 3, 6);
  put(*block.offset, slot, offset, 3);
  for (int64_t row = 0; row < k; row++) {
    const double *twist = a.branch_twist + 6 * (branch * k + row);
    put(block.base_rotation + 3 * row * WIDTH, slot, twist + 3, 3);
    double &steepest = block.steepest[row * WIDTH + slot];
    for (int64_t i = a.branch_first[branch]; i < a.branch_first[branch + 1]; i++) {
      const Vector<double> turn = read(a.segment_turn + 3 * (i * k + row));
      const double tip = row == 0 ? a.segment_tip_slope[i] : 0.0;
      steepest = most(steepest, most(dot(turn, turn), tip * tip));
    }
  }
  if (__builtin_fabs(offset[1]) > AS_ONE * offset[0] ||
      __builtin_fabs(offset[2]) > AS_ONE * offset[0])
    block.is_at_axes = 0;
  raise_to(block.n_slots, slot + 1);
  raise_to(block.n_rows, a.branch_keys[branch]);
  if (parent >= 0) raise_to(block.n_parent_rows, a.branch_keys[below]);
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
  model.n_blocks = slots.n_blocks;
  model.memory.take(slots.n_blocks, model.blocks);
  model.memory.take(slots.n_records, model.segments);
  Block *blocks = model.blocks;
  Segment *segments = model.segments;
  double *by_block, *turns = nullptr;
  model.memory.take(slots.n_blocks * 4 * k * WIDTH, by_block);
  if (k > 2) model.memory.take(slots.n_records * 3 * k * WIDTH, turns);
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
      const int64_t first = a.branch_first[branch], size = size_of(a, branch);
      block.first_record = record;
      raise_to(block.n_records, size);
      fill_branch(a, branch, block, slot);
      for (int64_t i = 0; i < size; i++)
        if (!fill_segment(a, first + i, segments[record + i], slot)) block.is_joined = 0;
      if (branch == 0) continue;
      const int64_t parent = a.branch_parent[branch];
      raise_to(blocks[slots.block[parent]].n_parents, slots.slot[parent] + 1);
    }
  }
  scratch.release();
}

}  // namespace sway
