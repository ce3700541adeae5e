// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The leaves of a kind at rest: cards with pictures of leaves. Every vertex belongs to a segment, whose pose the
 * vertex shader looks up and applies. */

import { STRIDE } from "../placing.js";
import { distance, multiply, turned } from "../quaternions.js";
import { hangs, lookOf, numbers, seeded, shapes } from "./looks.js";
import { leafPlace, reachOf } from "./mesh.js";
import { drawnLeaf, leafShare, leavesAlong, pictureWidth, wholeLeaf } from "./textures.js";

const {
  /** Largest size of cards over the usual one, where few are drawn; each then shows more leaves. */
  LARGEST_CARDS,
  /** Least length of a small card over that of a full one. */
  LEAST_CARD,
  /** Length of a small card in leaves, how many of these there are per area of the cluster, and size of a cluster of single
   * leaves in leaves. */
  SHOOT, DENSE, FEW_LEAVES,
  /** Area of all single leaves over that of their cluster, and the share of its card that a leaf fills. */
  FULLNESS, FILLED,
  /** How much a cluster is lit as a ball rather than as part of the crown. */
  ROUNDED,
  /** The same of a bough, and the most clusters on one over those of the tree. */
  BOUGH, MOST_ON_BOUGH,
  /** Largest size of a cluster over the mean one, as its leaves are larger with it. */
  LARGEST,
  /** How much lighter or darker a cluster is than others, and a card than others of it. */
  UNEVEN,
  /** Number of different twigs in clusters, of cards on one, half the width of its wood over the size of the cluster, and the part
   * of it before the first card of a tuft. */
  VARIETY, ON_TWIG, TWIG_WIDE, BARE_TWIG,
  /** Radius of wood that gets leaves or needles though it has no cluster, over the thickest that has one; size of these shoots
   * over that of a cluster, and at most [m]. */
  THIN, CLAD, BARE_SIZE, LARGEST_BARE,
  /** Length below which a limb under the crown is dead, over that of the longest. */
  DEAD,
  /** Lengths over the size of a shoot: below the first a branch without leaves stays bare; above the second a segment is
   * clothed all along. */
  STUB, LONG,
  /** Droop from which on a tree weeps, and how much thicker wood gets leaves with it, as hanging
   * shoots hide the boughs. */
  WEEPS, CURTAIN,
  /** Candles of flowers: length over that of a leaf, width over length, how open to the sky the twigs below are at
   * least, and the share of these that bear one. */
  CANDLE, CANDLE_WIDE, CANDLE_OPEN, CANDLES,
  /** Height up to which animals browse the leaves, and the same under a curtain [m]. */
  BROWSED, LEAST_BROWSED,
  /** How far a card bends down at its end, over its length. */
  BOW,
} = /** @type {Record<string, any>} */ (numbers.foliage);
/** Whether a tree weeps. @param {Look} look */
const weeps = ({ droop = 0 }) => droop > WEEPS;
/** Orientation of a shoot that hangs straight down. */
const DOWN = [0, Math.SQRT1_2, 0, Math.SQRT1_2];
/** Numbers per vertex of a card. */
const PER_VERTEX = 19;
const ORIGIN = [0, 0, 0];

/** Mesh of the leaves on some branches. A cluster is up to three large cards that cross each other about its shoot, or
 * many small ones about its twig. Cards come in a mixed order, so that any first part of them is a thinner crown.
 * A vertex has the row of its segment, then place (3), motion with the flutter (3), normal (3), direction of the light
 * (3), frequency and phase of the flutter (2), openness, tint, and place in the picture (2).
 * @param {Shape} shape @param {Int32Array} branches that are drawn @param {number} cards @param {number} most
 * cards of the whole crown, whose area fewer have as well @param {boolean} isFlowering
 * @param {boolean} [isPlain] whether a large card is one triangle, as each costs much without a graphics unit
 * @returns {{mesh: Mesh, along: number, isSpread: boolean}} with the number of leaves along the picture, and whether
 * cards are small ones */
export function leafMesh(shape, branches, cards, most, isFlowering, isPlain = false) {
  const { kind, placer, rest, high, highest, shade } = shape;
  const { leaf_segment: carrier, leaf_size: sizes } = kind.arrays;
  if (!carrier?.length) return { mesh: { values: [], indices: [] }, along: 1, isSpread: false };
  const random = seeded();
  const meanSize = Array.from(sizes).reduce((sum, size) => sum + size, 0) / sizes.length;
  const look = lookOf(kind);
  const { each, along, spray, isSpread } = cardsOf(look, meanSize, carrier.length, cards, most);
  const shoots = mixed(Array.from(carrier, (_, i) => leafyShoot(kind, rest, i)), random).slice(0, cards);
  if (isSpread) shoots.push(...bareShoots(kind, look, rest, branches, meanSize));
  const dead = look.has_needles ? deadWood(kind, rest, highest) : new Set();
  const twigs = isSpread ? Array.from({ length: VARIETY }, () => leafyTwig(look, spray, random)) : [];
  const onTwig = Math.min(ON_TWIG, each);
  const axis = twigCorners(ORIGIN, [0.7 * look.spray.length, 0, 0], [0, 1, 0]);
  const hung = hungOn(kind, branches);
  const boughOf = boughs(kind, rest);
  const leaves = leafShare(look, along, isFlowering); // part of the picture, whose rest are flowers
  const candle = candleCorners(CANDLE * wholeLeaf(look));
  const lowest = lowestLeaves(look, rest[2], high[2]);
  const values = /** @type {number[]} */ ([]);
  const faces = /** @type {number[][]} */ ([]);
  for (const shoot of shoots) {
    if (dead.has(shoot.segment)) continue;
    // All of a clump or none of it: a few of its leaves would float in the air.
    if (isSpread && shoot.at[2] < lowest) continue;
    if (isSpread) shoot.size = Math.min(shoot.size, LARGEST * meanSize);
    const row = placer.slots[hung[shoot.segment]];
    const o = STRIDE * hung[shoot.segment];
    const origin = rest.subarray(o, o + 3);
    const back = [-rest[o + 4], -rest[o + 5], -rest[o + 6], rest[o + 7]]; // from the tree's frame to the segment's
    const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => turned(shoot.frame, axis));
    const own = axes.map((axis) => turned(back, axis));
    const middle = inFrame(axes, [isSpread ? 0.42 * look.spray.length - 0.5 : 0.8 * spray.length - 0.5, 0, 0], shoot.size, shoot.at);
    const centre = turned(back, shoot.at.map((a, c) => a - origin[c]));
    const bough = boughOf(shoot.segment);
    let twig = twigs[0];
    const count = isSpread ? Math.max(2, shoot.share * each * (1 + 1 / onTwig)) : each;
    for (let card = isSpread ? -1 : 0; card < count; card++) {
      const part = card % (onTwig + 1);
      if (!part) twig = twigs[Math.floor(VARIETY * random())];
      const corners = isSpread ? (card < 0 ? axis : twig[part]) : cardCorners(spray, shoot.phase, card, isPlain ? shapes.triangle : shapes.square);
      const end = inFrame(axes, corners[corners.length - 2].place, shoot.size, shoot.at);
      if (isSpread && end[2] < 0.4 * rest[2] + 0.6 * lowest) continue;
      const { open, towards } = shade(end);
      const light = turned(back, towards.map((each, c) => each + (ROUNDED / shoot.size) * (end[c] - middle[c]) + (BOUGH / bough.radius) * (end[c] - bough.centre[c])));
      // Leaves within a bough are darker than those at its surface.
      const tint = (isSpread ? 0.6 + 0.55 * Math.min(1, distance(end, bough.centre) / bough.radius) : 1) + UNEVEN * Math.sin(7 * shoot.phase + card);
      const flutter = [shoot.frequency, shoot.phase + 2.4 * card];
      faces.push(facesFrom(values.length / PER_VERTEX, corners.length));
      for (const { place, swing, normal, u, v } of corners) {
        values.push(row, ...inFrame(own, place, shoot.size, centre), ...inFrame(own, swing, shoot.size));
        values.push(...inFrame(own, normal, 1), ...light, ...flutter, open, tint, leaves * u, v);
      }
      if (part || card + onTwig > count || leaves === 1 || open < CANDLE_OPEN || random() > CANDLES) continue;
      // A candle stands upright at the end of a twig that has all its leaves.
      for (const quad of [0, 4]) faces.push(facesFrom(values.length / PER_VERTEX + quad, 4));
      const foot = end.map((each, c) => each - origin[c]);
      for (const { place, normal, u, v } of candle) {
        values.push(row, ...turned(back, place.map((each, c) => each + foot[c])), ...ORIGIN);
        values.push(...turned(back, normal), ...turned(back, [0.7, 0.3, 2]), ...flutter, 1, 0.85, leaves + (1 - leaves) * v, u);
      }
    }
  }
  return { mesh: { values, indices: mixed(faces, random).flat() }, along, isSpread };
}

/** Height below which there is no clump of leaves [m]; a tree in a pot has no such limit.
 * @param {Look} look @param {number} foot height of the foot of the tree @param {number} top */
function lowestLeaves(look, foot, top) {
  if (look.is_potted) return -Infinity;
  return foot + (weeps(look) ? LEAST_BROWSED : Math.min(BROWSED, 0.11 * (top - foot)));
}

/** Finds the bough of a segment, the longest line of its ancestors that bears few enough clusters: the middle of these, and the radius
 * of a ball of them [m]. @param {Kind} kind @param {Float32Array} rest */
function boughs(kind, rest) {
  const { arrays: { branch_first: first, branch_parent: parents, leaf_segment: carrier, leaf_size: sizes }, nBranches } = kind;
  const owner = (/** @type {number} */ segment) => first.findIndex((from) => from > segment) - 1;
  const sums = Array.from({ length: nBranches }, () => [0, 0, 0, 0]);
  const add = (/** @type {number[]} */ sum, /** @type {number[]} */ more) => more.forEach((each, c) => (sum[c] += each));
  carrier.forEach((segment, i) => add(sums[owner(segment)], [...leafPlace(kind, rest, i), 1]));
  for (let branch = nBranches - 1; branch > 0; branch--) add(sums[parents[branch]], sums[branch]);
  return (/** @type {number} */ segment) => {
    let branch = owner(segment);
    while (!sums[branch][3] || sums[parents[branch]]?.[3] < MOST_ON_BOUGH * carrier.length) branch = parents[branch];
    const [x, y, z, count] = sums[branch];
    return { centre: [x / count, y / count, z / count], radius: 0.6 * sizes[0] * Math.cbrt(count) };
  };
}

/** Triangles of a card from its first vertex. @param {number} v @param {number} corners */
const facesFrom = (v, corners) => (corners === 3 ? [v, v + 1, v + 2] : [v, v + 1, v + 2, v, v + 2, v + 3]);

/** A scaled vector of a frame, added to a place. @param {number[][]} axes
 * @param {number[]} vector @param {number} scale @param {number[]} [from] */
function inFrame([a, b, c], [x, y, z], scale, from = ORIGIN) {
  return from.map((each, k) => each + scale * (x * a[k] + y * b[k] + z * c[k]));
}

/** A cluster of the description as a shoot. @param {Kind} kind @param {Float32Array} rest
 * @param {number} i number of the cluster @returns {Shoot} */
function leafyShoot(kind, rest, i) {
  const { leaf_segment: carrier, leaf_orientation: orientation, leaf_size: sizes, leaf_phase: phases,
    leaf_frequency: frequencies } = kind.arrays;
  const [w, x, y, z] = orientation.subarray(4 * i, 4 * i + 4);
  const own = [0, 0, 0, 1];
  multiply(rest, STRIDE * carrier[i] + 4, [x, y, z, w], 0, own);
  const at = leafPlace(kind, rest, i);
  const look = lookOf(kind);
  // Some shoots of a larch clothe the back of their limb.
  const isHanging = hangs(look) && (look.form !== "bunches" || i % 3 > 0);
  // Some twigs hang straight down from where they grow.
  if (isHanging) turned(own, [1, 0, 0]).forEach((each, c) => (at[c] -= 0.5 * sizes[i] * (each + Number(c > 1))));
  return { segment: carrier[i], at, frame: isHanging ? DOWN : own, size: sizes[i], phase: phases[i], frequency: frequencies[i], share: 1 };
}

/** Segments of a conifer's dead stubs, which bear no needles: limbs on the stem below the longest one and much shorter, with
 * their branches. @param {Kind} kind @param {Float32Array} rest @param {number} highest segment, up to which the stem goes */
export function deadWood({ arrays, nBranches }, rest, highest) {
  const { branch_first: first, branch_parent: parents } = arrays;
  const stem = /** @type {Set<number>} */ (new Set());
  for (let part = first.findIndex((from) => from > highest) - 1; part >= 0; part = parents[part]) stem.add(part);
  const limbs = Array.from(parents, (parent, branch) => ({ parent, branch, reach: reachOf(arrays, branch), base: rest[STRIDE * first[branch] + 2] }))
    .filter(({ parent, branch }) => !stem.has(branch) && stem.has(parent));
  const longest = limbs.reduce((most, each) => (each.reach > most.reach ? each : most), { reach: 0, base: 0 });
  const dead = new Set(limbs.filter(({ reach, base }) => reach < DEAD * longest.reach && base < longest.base).map(({ branch }) => branch));
  const segments = new Set();
  for (let branch = 0; branch < nBranches; branch++) {
    if (dead.has(parents[branch])) dead.add(branch);
    if (!dead.has(branch)) continue;
    for (let segment = first[branch]; segment < first[branch + 1]; segment++) segments.add(segment);
  }
  return segments;
}

/** Shoots at the end of each branch and along thin wood without a cluster, so that none of it is bare.
 * @param {Kind} kind @param {Look} look @param {Float32Array} rest @param {Int32Array} branches that are drawn
 * @param {number} mean size of clusters [m] @returns {Shoot[]} */
function bareShoots({ arrays }, look, rest, branches, mean) {
  const { branch_first: first, segment_length: length, segment_radius: radius, leaf_segment: carrier } = arrays;
  const leafy = new Set(carrier);
  const thickest = Math.max(...Array.from(leafy, (segment) => radius[2 * segment]));
  /** @type {Shoot[]} */
  const shoots = [];
  const isWeeping = weeps(look);
  const size = isWeeping ? mean : Math.min(BARE_SIZE * mean, LARGEST_BARE);
  const leafiest = thickest * (look.has_needles ? CLAD : THIN + CURTAIN * Math.max(0, look.is_potted ? 0 : look.droop ?? 0));
  const share = (size / mean) ** 2;
  /** @param {number} segment @param {number} along [m] */
  const add = (segment, along) => {
    const o = STRIDE * segment;
    const own = Array.from(rest.subarray(o + 4, o + 8));
    const at = turned(own, [along, 0, 0]).map((each, c) => each + rest[o + c]);
    // Every second one of a weeping bough clothes its back.
    shoots.push({ segment, at, frame: isWeeping && shoots.length % 2 ? DOWN : own, size, phase: 2.4 * shoots.length, frequency: arrays.leaf_frequency[0], share });
  };
  for (const branch of branches) {
    const end = first[branch + 1] - 1;
    // A short stub stays bare: its few leaves would float in the air.
    if (reachOf(arrays, branch) > STUB * size || leafy.has(end)) add(end, length[end] - 0.5 * size);
    for (let segment = first[branch]; segment <= end; segment++) {
      // A cluster clothes no long shoot from its foot on, and no branch of a conifer.
      if (look.form === "tufts" || radius[2 * segment] > leafiest || (leafy.has(segment) ? !look.has_needles && length[segment] < LONG * size : segment === end)) continue;
      const count = Math.ceil(length[segment] / ((isWeeping ? 0.7 : 1.5) * size));
      for (let k = 0; k < count; k++) add(segment, ((k + 0.5) * length[segment]) / count);
    }
  }
  return shoots;
}

/** Cards of each cluster at a level: how many, their size, the leaves along their picture, and whether they are small
 * ones spread over the cluster. @param {Look} look @param {number} mean size of clusters [m]
 * @param {number} clusters how many there are @param {number} cards of the level @param {number} most */
function cardsOf(look, mean, clusters, cards, most) {
  const { rolls, length, width } = look.spray;
  const perCluster = (/** @type {number} */ all) => Math.max(1, Math.floor(all / clusters));
  const each = perCluster(cards);
  const leaf = wholeLeaf(look);
  const alone = { rolls, width: pictureWidth(look, 1), length: Math.min(length, (1.4 * leaf) / mean) };
  if (each <= rolls.length) {
    // As much area as all cards of full size have.
    const whole = clusters * Math.min(rolls.length, perCluster(most));
    const larger = Math.min(LARGEST_CARDS, Math.sqrt(whole / (Math.min(clusters, cards) * each)));
    const along = leavesAlong(look, larger * length * mean);
    return { each, along, spray: along > 1 ? { rolls, width, length: larger * length } : alone, isSpread: false };
  }
  if (look.has_needles || mean > FEW_LEAVES * leaf) {
    // Shoots with leaves, as large as they are: a leaf alone would be a fleck in the air.
    const small = length * Math.max(LEAST_CARD, Math.sqrt(2 / each));
    const long = Math.max(small, (SHOOT[look.form] ?? SHOOT.usual) * drawnLeaf(look) / mean);
    const along = leavesAlong(look, long * mean);
    const spray = { rolls, width: pictureWidth(look, along, true), length: long };
    return { each: Math.max(1, Math.round(each * Math.min(1, DENSE * (small / long) ** 2))), along, spray, isSpread: true };
  }
  const size = leaf / mean;
  const leaves = (FULLNESS * Math.PI) / (4 * FILLED * alone.width * size * size);
  const spray = { ...alone, length: (look.is_potted ? 0.65 : 1) * size };
  return { each: Math.max(1, Math.min(each, Math.round(leaves))), along: 1, spray, isSpread: true };
}

/** Corners of a card of a cluster of size 1: place, motion, normal, in the frame of the cluster; in the picture.
 * `tree_mesh.py` has those of files. @param {Spray} spray @param {number} phase of the flutter of the cluster,
 * which makes each of its own @param {number} card its number @param {number[][]} outline its corners in the picture */
function cardCorners({ length, width, rolls }, phase, card, outline) {
  const roll = rolls[card % rolls.length] + 0.3 * Math.sin(phase);
  const yaw = 0.35 * Math.sin(phase + 2.1 * card);
  const around = [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
  multiply(around, 0, [Math.sin(roll / 2), 0, 0, Math.cos(roll / 2)], 0, around);
  return cornersOf((u, v) => {
    const place = hanging(turned(around, [u * length, v * width * length, 0]), BOW * length * u);
    return { place, swing: [0, -place[2], place[1]], normal: turned(around, [0.3 * u, 1.2 * Math.min(0.5, Math.max(-0.5, v)), 1]) };
  }, outline);
}

/** Corners of the wood of a twig in a cluster of size 1, which lie beside the picture, and of the small cards along it.
 * @param {Look} look @param {Spray} spray the cards' own @param {() => number} random */
function leafyTwig(look, { length, width }, random) {
  const whole = look.spray.length;
  const wide = look.spray.width * whole;
  const { depth: deep = 0.8, droop = 0 } = look;
  const bare = look.form === "tufts" ? BARE_TWIG : 0.04;
  const some = () => random() + random() - 1;
  // Twigs end at the surface of the cluster, where the light is, and leaves stand towards their ends.
  const way = unit([some(), some(), some()]);
  const far = 0.75 + 0.25 * random();
  const end = [whole * (0.42 + 0.42 * far * way[0]), 0.8 * wide * far * way[1], 0.8 * deep * wide * far * way[2]];
  // Hanging ones are beside each other like threads of a curtain, others radiate from their shoot.
  const apart = hangs(look) && !look.is_potted ? 0.9 : 0;
  const foot = [Math.max(0, end[0] - 0.6 * Math.hypot(end[1], end[2])) * random(), apart * end[1], apart * end[2]];
  const along = end.map((each, c) => each - foot[c]);
  const spread = hangs(look) ? 1.4 - 1.2 * droop : look.has_needles ? 0.6 : 1.4;
  const cards = Array.from({ length: ON_TWIG }, (_, i) => {
    const far = bare + (1 - bare) * ((i + random()) / ON_TWIG) ** (hangs(look) ? 1 : 0.5);
    const away = unit(unit(along).map((each, c) => each + spread * some() + Number(c > 1 && look.form === "fronds")));
    // Leaves face outward and up, the more so the flatter the cluster is.
    const across = unit(cross(way.map((each, c) => each + 1.2 * deep * some() + Number(c > 1 && !hangs(look))), away));
    const normal = cross(away, across);
    return cornersOf((u, v) => ({
      place: hanging(foot.map((each, c) => each + far * along[c] + length * ((u - 0.15) * away[c] + v * width * across[c])), BOW * length * u),
      swing: normal.map((each) => length * (0.4 * u + v * width) * each),
      normal: normal.map((each, c) => each + 0.3 * u * away[c] + 0.5 * v * across[c]),
    }));
  });
  return [twigCorners(foot, end, unit(cross(along, [some(), some(), some()]))), ...cards];
}

/** @param {number[]} foot @param {number[]} end @param {number[]} across */
function twigCorners(foot, end, across) {
  return cornersOf((u, v) => ({
    place: hanging(foot.map((each, c) => each + u * (end[c] - each) + 2 * v * TWIG_WIDE * (1 - 0.6 * u) * across[c]), 0),
    swing: ORIGIN, normal: cross(across, unit(end.map((each, c) => each - foot[c]))),
  })).map((each) => ({ ...each, u: -1 }));
}

/** Corners of two crossed cards with a candle of flowers, whose foot is at 0; the picture goes from its tip down.
 * @param {number} long [m] */
function candleCorners(long) {
  const wide = CANDLE_WIDE * long;
  return [[1, 0], [0, 1]].flatMap(([x, y]) => cornersOf((down, across) => ({
    place: [x * wide * across, y * wide * across, long * (1 - down)], normal: [y, -x, 0.5],
  })));
}

/** Corners of a picture. @template T @param {(u: number, v: number) => T} at @param {number[][]} [outline] of them */
function cornersOf(at, outline = shapes.square) {
  return outline.map(([u, v]) => ({ ...at(u, v), u, v: 0.5 + v }));
}

/** A place from the foot of the shoot, and lower. @param {number[]} place @param {number} low */
const hanging = ([x, y, z], low) => [x - 0.5, y, z - low];

/** @param {number[]} v */
const unit = (v) => v.map((each) => each / (Math.hypot(...v) || 1));

/** @param {number[]} a @param {number[]} b */
const cross = (a, b) => [0, 1, 2].map((c) => a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3]);

/** In a random order. @template T @param {T[]} items @param {() => number} random */
function mixed(items, random) {
  return items.map((item) => ({ item, key: random() })).sort((a, b) => a.key - b.key).map(({ item }) => item);
}

/** The drawn segment that each segment moves with: itself, or what carries the branch left out.
 * @param {Kind} kind @param {Int32Array} branches */
function hungOn({ arrays, nSegments, nBranches }, branches) {
  const hung = Int32Array.from({ length: nSegments }, (_, i) => i);
  const drawn = new Set(branches);
  for (let branch = 0; branch < nBranches; branch++) {
    if (drawn.has(branch)) continue;
    const under = hung[arrays.branch_base_segment[branch]];
    hung.fill(under, arrays.branch_first[branch], arrays.branch_first[branch + 1]);
  }
  return hung;
}
