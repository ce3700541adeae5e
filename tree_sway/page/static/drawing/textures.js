// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Pictures painted by code: leaves, alone or in sprays, cut out by their alpha; and bark. */

import { barks, numbers, outlineOf, places, seeded } from "./looks.js";

const {
  /** Numbers of leaves along a picture: a single leaf, then longer and longer sprays. */
  ALONG,
  /** Length of a drawn leaf over that of a real one, so that one sees its form from afar. */
  DRAWN,
  /** Length of a whole leaf that is drawn as it is [m]. */
  LARGE,
  /** Length of a whole leaf in leaflets. */
  IN_LEAFLETS,
  /** Width over length of a leaf with leaflets. */
  WITH_LEAFLETS,
  /** Width of the leaf beside a candle of flowers, over that of the picture. */
  LEAF_SHARE,
  /** Width of small cards of short needles over that of others. */
  TWIG,
  /** Short needles: gap between side shoots over the length of a shoot, and the least of the picture; length of a needle over the
   * gap; how far side shoots lean from their axis, and needles [rad]; the distance of bunches. */
  NEEDLES,
  /** Length of the part of a shoot that long needles clothe, over their length. */
  BRUSH,
  /** Number of layers of leaves; the lowest is shaded by the others. */
  LAYERS,
  /** Length of the midrib of a leaf or leaflet, and its veins. */
  VEINS,
  /** Width of a picture of bark [px]; it is twice as high, and repeats beyond its edges. */
  BARK_WIDE,
} = /** @type {Record<string, any>} */ (numbers.pictures);

/** Length at which a leaf or leaflet is drawn [m]: large leaves are seen from afar as they are. @param {Look} look */
export const drawnLeaf = ({ form, has_needles: hasNeedles, leaf_size: size }) =>
  size * (hasNeedles || size * (IN_LEAFLETS[form] ?? 1) > LARGE ? 1 : DRAWN);

/** Length of a drawn leaf with all its leaflets [m]. @param {Look} look */
export const wholeLeaf = (look) => drawnLeaf(look) * (IN_LEAFLETS[look.form] ?? 1);

/** Width of a picture over its length.
 * @param {Look} look @param {number} along as in `leafPicture` @param {boolean} [isSpread] of small cards */
export const pictureWidth = ({ form, slenderness, spray }, along, isSpread = false) =>
  along > 1 ? spray.width * (isSpread ? TWIG[form] ?? 1 : 1) : WITH_LEAFLETS[form] ?? Math.min(1, slenderness);

/** Part of the width of a picture that has leaves; the flowers of a horse chestnut are beside them.
 * @param {Look} look @param {number} along as in `leafPicture` @param {boolean} isFlowering */
export const leafShare = ({ form }, along, isFlowering) =>
  (isFlowering && form === "digitate" && along === 1 ? LEAF_SHARE : 1);

/** Number of leaves along the picture for cards of a length, so that none is drawn much larger than it is.
 * @param {Look} look @param {number} long length of a card [m] */
export function leavesAlong(look, long) {
  const least = look.form in IN_LEAFLETS ? 8 : look.has_needles ? 3 : 1;
  return ALONG.find((/** @type {number} */ along) => along >= Math.max(least, long / drawnLeaf(look))) ?? ALONG[ALONG.length - 1];
}

/** Paint the leaves of a shoot. @param {Look} look @param {number} along how many are as long as the picture
 * @param {{isAutumn?: boolean, isFlowering?: boolean, isSpread?: boolean, size?: number}} [options] whether it is
 * of small cards, and its size [px] */
export function leafPicture(look, along, { isAutumn = false, isFlowering = false, isSpread = false, size } = {}) {
  const share = leafShare(look, along, isFlowering);
  const pixels = size ?? (along > 1 ? 512 : look.form in IN_LEAFLETS ? 512 : 128);
  const brush = new Brush(look, isAutumn, pixels, pictureWidth(look, along, isSpread), seeded(97 + along), share);
  if (share < 1) brush.candle();
  if (along === 1) brush.leaf(0.99, 0.8);
  else if (look.form === "tufts") (along < 5 ? places.tuft : places.tufts).forEach((end) => brush.tuft(end));
  else if (look.has_needles) brush.needles(1 / along);
  // Small cards are seen as leaves and gaps, and not as a leaf each.
  else brush.spray(1 / along, isSpread ? 0.65 : 0.75);
  return brush.context.canvas;
}


/** @param {number[]} color @param {number} light */
const css = (color, light) => `rgb(${color.map((c) => Math.round(255 * Math.min(1, light * c))).join(" ")})`;

/** Paint bark as shares of its colour: ragged ellipses at random places of a picture that repeats. @param {string} pattern
 * @returns {HTMLCanvasElement} */
export function barkPicture(pattern) {
  const { ground, marks } = barks[pattern] ?? barks.flakes;
  const random = seeded(61);
  const [width, height] = [BARK_WIDE, 2 * BARK_WIDE];
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  context.fillStyle = css([1, 1, 1], ground);
  context.fillRect(0, 0, width, height);
  for (const [count, rough, ...ranges] of marks) {
    for (let i = 0; i < count; i++) {
      const [light, across, tall, x, y, lean] = [...ranges, [0, width], [0, height], [-0.15, 0.3]].map(([least, more]) => least + more * random());
      const corners = Array.from({ length: 12 }, (_, k) => {
        const [far, turn] = [1 - rough * random(), (Math.PI * k) / 6];
        return [x + far * (across * Math.cos(turn) + lean * tall * Math.sin(turn)), y + far * tall * Math.sin(turn)];
      });
      context.fillStyle = css([1, 1, 1], light);
      // Parts beyond the edges lie on the other side.
      for (const dx of [-width, 0, width]) {
        for (const dy of [-height, 0, height]) context.fill(new Path2D(`M${corners.map(([a, b]) => [a + dx, b + dy]).join("L")}Z`));
      }
    }
  }
  return canvas;
}

/** Paints a shoot that begins in the middle of the left edge. The picture has a length of 1 and the width of the
 * spray. */
class Brush {
  /** @param {Look} look @param {boolean} isAutumn @param {number} size [px] @param {number} width over length
   * @param {() => number} random @param {number} [share] of the picture's width that is painted on */
  constructor(look, isAutumn, size, width, random, share = 1) {
    const turned = isAutumn && look.autumn;
    this.base = turned ? turned : look.green;
    this.fresh = turned ? turned.map((c) => 1.2 * c) : look.fresh;
    this.look = look;
    this.random = random;
    this.half = 0.5 * width;
    this.unit = IN_LEAFLETS[look.form] ?? 1;
    const half = outlineOf(look).map(([x, y]) => [x, 0.5 * look.slenderness * y]);
    const other = half.map(([x, y]) => [x, -y]).reverse();
    this.blades = [[...half, ...other], half].map((outline) => new Path2D(`M${outline.join("L")}Z`));
    const canvas = Object.assign(document.createElement("canvas"), { width: size, height: size });
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    // The picture fills the texture, however wide the card is.
    this.context.setTransform(share * size, 0, 0, size / width, 0, size / 2);
    this.context.lineCap = "round";
  }

  /** A colour of a leaf. @param {number} light @param {number} young 0 to 1, the share of the colour of a fresh one */
  color(light, young) {
    const { random, base, fresh } = this;
    const mixed = young + 0.3 * random();
    return css(base.map((c, i) => c + mixed * (fresh[i] - c)), light * (0.9 + 0.2 * random()));
  }

  /** Paint in another frame. @param {number} x @param {number} y @param {number} turn @param {number} scale
   * @param {() => void} paint */
  at(x, y, turn, scale, paint) {
    const [c, s] = [scale * Math.cos(turn), scale * Math.sin(turn)];
    this.context.save();
    this.context.transform(c, s, -s, c, x, y);
    paint();
    this.context.restore();
  }

  /** A straight line. @param {number | string} long, and more of the path @param {number} width @param {string} color */
  line(long, width, color) {
    Object.assign(this.context, { strokeStyle: color, lineWidth: width });
    this.context.stroke(new Path2D(`M0 0H${long}`));
  }

  /** A shoot whose leaves, in layers, hang on twigs of its axis: fewer and fewer from its middle on, as any outline would
   * look from afar like that of one large leaf. @param {number} leaf length of one @param {number} filled area
   * of the leaves over that of the picture */
  spray(leaf, filled) {
    const { half, random, look } = this;
    const unit = this.unit * leaf;
    const count = Math.round((filled * 2 * half) / (unit * unit * Math.max(0.7, Math.sqrt(look.slenderness))));
    const places = Array.from({ length: count }, () => {
      const [turn, far, size] = [7 * random(), random() ** 0.55, unit * (0.75 + 0.35 * random())];
      const [x, y] = [0.5 + 0.5 * (1 - unit) * far * Math.cos(turn), (half - 0.5 * unit) * far * Math.sin(turn)];
      const lean = Math.atan2(y, 0.4) + 2.4 * (random() - 0.5);
      return { x: x - 0.5 * size * Math.cos(lean), y: y - 0.5 * size * Math.sin(lean), lean, size };
    });
    const twig = (/** @type {number} */ long) => this.line(long, 0.02 * leaf, css(look.twig, 0.8));
    twig(0.6);
    for (const { x, y } of places.slice(0, count / 3)) {
      const foot = Math.max(0, x - 1.2 * Math.abs(y));
      this.at(foot, 0, Math.atan2(y, x - foot), 1, () => twig(Math.hypot(x - foot, y)));
    }
    places.forEach(({ x, y, lean, size }, i) => {
      const light = 0.65 + (0.4 * Math.floor((LAYERS * i) / count)) / (LAYERS - 1);
      this.at(x, y, lean, 1, () => this.leaf(size, light));
    });
  }

  /** A branchlet with side shoots clad in needles, apart from each other like fingers: dark near the axis,
   * lighter at the tips. @param {number} shoot length of needles and shoot together */
  needles(shoot) {
    const { look: { form, twig }, random, half } = this;
    const [gap, least, share, leaning, tilted, knot] = NEEDLES[form];
    const apart = Math.max(least, gap * shoot);
    const long = share * apart;
    const wide = Math.min(0.1 * long, 0.009);
    /** @type {number[][]} */
    const shoots = [[0, 0, 0, 1 - 0.9 * long]];
    let side = 1;
    for (let x = 0.02; x < 0.9; x += 0.45 * apart, side = -side) {
      const lean = side * leaning * (0.8 + 0.2 * random());
      const reach = ((0.7 + 0.3 * random()) * (half - 0.5 * long) * (1.05 - x) ** 0.6) / Math.abs(Math.sin(lean));
      shoots.push([x, 0, lean, Math.min(reach, 1.1 - x)]);
      for (let far = apart; far < reach - 0.5 * apart; far += apart) {
        shoots.push([x + far * Math.cos(lean), far * Math.sin(lean), lean - 0.8 * side, 0.5 * (reach - far)]);
      }
    }
    for (const isUpper of [false, true]) {
      for (const [x, y, lean, reach] of shoots) {
        this.at(x, y, lean, 1, () => {
          if (!isUpper) this.line(reach, 0.02 * apart + 0.003, css(twig, 0.7));
          const count = Math.max(5, ((isUpper ? 0.6 : 0.9) * reach) / wide);
          for (let i = 0; i < count; i++) {
            const far = (knot / reach) * Math.round(((i + random()) / count) * (reach / knot));
            const out = 0.5 * Math.hypot(x, y) + 0.5 * far;
            const color = this.color((isUpper ? 0.72 : 0.45) + 0.4 * out, 0.3 * far);
            const tilt = (i % 2 ? 1 : -1) * tilted * (0.6 + 0.4 * random()) * (isUpper ? 0.8 : 1);
            this.at(far * reach, 0, tilt, 1, () => this.line(long * (0.6 + 0.4 * random()), wide, color));
          }
        });
      }
    }
  }

  /** A shoot with long needles on every side, few enough that one sees between them from afar: dark ones
   * below, lighter ones above. @param {number[]} end its place, the longest needle, and how many are on each side of the picture */
  tuft([x, across, long, count]) {
    const { look: { twig }, random, half } = this;
    const y = half * across;
    const heading = Math.atan2(0.6 * y, 0.4);
    this.at(0, 0, Math.atan2(y, x), 1, () => this.line(Math.hypot(x, y), 0.016, css(twig, 0.8)));
    for (const isUpper of [false, true]) {
      for (let i = 0; i < count; i++) {
        // Along the shoot, so that it is a brush, and no star, which would be a leaf of a maple.
        const before = Math.min(BRUSH * long, 0.8 * x) * random();
        const [fromX, fromY] = [x - before * Math.cos(heading), y - before * Math.sin(heading)];
        const turn = heading + (i % 2 ? 1 : -1) * (0.2 + 0.9 * random());
        const room = (half - Math.abs(fromY)) / Math.abs(Math.sin(turn));
        // About as long as each other: from afar long ones among short ones would be the lobes of a leaf.
        const reach = Math.min(long * (0.82 + 0.18 * random()), 0.99 - fromX, room);
        const color = this.color((isUpper ? 0.72 : 0.4) + 0.25 * random(), 0.1);
        this.at(fromX, fromY, turn, 1, () => this.line(reach, 0.009, color));
      }
    }
  }

  /** One leaf from its stalk on. @param {number} long @param {number} light */
  leaf(long, light) {
    const { context, look } = this;
    const blade = () => {
      context.fillStyle = this.color(light, 0);
      context.fill(this.blades[0]);
      // One half lies in the shade of the other; the midrib is light, and so are the veins but of evergreen leaves.
      context.fillStyle = "rgb(0 0 0 / 14%)";
      context.fill(this.blades[1]);
      this.line(look.autumn ? VEINS : 0.9, 0.015, "rgb(255 255 200 / 15%)");
    };
    this.at(0, 0, 0, long, () => {
      if (look.form in IN_LEAFLETS) this.leaflets(blade, this.color(light, 0));
      else blade();
    });
  }

  /** A candle of cream flowers with pink and yellow spots beside the leaf, round, and less high than the picture; its
   * colours allow for those that green is dulled by. */
  candle() {
    const { random } = this;
    const [middle, half] = [0.5 * (1 + 1 / LEAF_SHARE), 0.3 * (1 / LEAF_SHARE - 1)];
    for (let i = 0; i < 150; i++) {
      const up = random();
      const reach = half * (1 - up) ** 0.6;
      const color = css(places.candle[i % 5], 0.75 + 0.25 * random());
      this.at(middle + reach * (2 * random() - 1), 0.38 - 0.78 * up, 0, 1, () => this.line("0V.018", 0.02, color));
    }
  }

  /** Leaflets along a stalk, or like fingers at its end, the last one on its tip. @param {() => void} blade paints one
   * @param {string} color of the stalk */
  leaflets(blade, color) {
    const { look: { form }, random } = this;
    const leaflets = places[form];
    this.line(leaflets[leaflets.length - 1][0], 0.018, color);
    for (const [along, lean, share] of leaflets) {
      this.at(along, 0, lean + 0.12 * (random() - 0.5), share, blade);
    }
  }
}
