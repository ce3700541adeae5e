// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Types of what is sent, drawn and shown, for the checks of JSDoc and for editors. */

// What is sent: see doc/streaming.md.

type NumberArray = Float32Array | Int32Array | Int16Array | Uint8Array;
type Numbers = NumberArray | Float64Array | number[];
type Arrays = Record<string, { values: NumberArray; shape: number[] }>;
type Vector = [number, number, number];
/** Type and axes of arrays by name. */
type Forms = Record<string, ["f32" | "i32" | "i16" | "u8", ...(string | number)[]]>;

/** What trees of one shape share. */
interface Kind {
  species: string;
  /** That of an average broadleaf if left out. */
  look?: Look;
  /** [m] */
  height: number;
  model: string;
  /** What the basis leaves out [m]. */
  basis_error: number;
  /** Young's modulus of its wood [Pa]. */
  modulus?: number;
  branch_names: string[];
  nSegments: number;
  nBranches: number;
  nCoordinates: number;
  /** Key rotations. */
  nKeys: number;
  arrays: Record<string, NumberArray>;
}

interface Tree {
  name: string;
  /** Its number among the kinds. */
  kind: number;
  /** [m] */
  height: number;
  /** x, y, z [m], how far it is turned about the vertical [rad], its scale. */
  place: number[];
  /** Among those of all trees. */
  firstSegment: number;
  firstCoordinate: number;
  firstKey: number;
}

interface Description {
  name: string;
  frame_id: string;
  identity: string;
  /** What frames carry of the identity. */
  shortIdentity: number;
  kinds: Kind[];
  trees: Tree[];
  /** Law of the leaves. */
  flutter: { gain: number; largest_angle: number } | null;
  /** Of all trees. */
  nSegments: number;
  nCoordinates: number;
  /** Of each coordinate at full scale. */
  scale: Float32Array;
}

interface Frame {
  identity: number;
  sequence: number;
  /** Of the sender's clock [ms]. */
  stamp: number;
  flags: number;
  /** Blowing to [m/s]. */
  wind: Vector;
  /** In their own unit, then what `beyond` reads; none in a frame of the wind alone. */
  coordinates: Float32Array;
  /** Number of the first of them. */
  first: number;
}

interface Tables {
  /** Identity of what they belong to. */
  description: string;
  /** Where the wind is measured [m]; upwind of all if null. */
  anemometer: number[] | null;
  /** Speed of gusts over that of the mean wind. */
  ratio: number;
  kinds: import("./sway.js").Table[];
  /** Wind of each tree over that of its kind. */
  speeds: ArrayLike<number>;
}

/** Who hears what comes over a line. */
interface Listeners {
  onState: (state: "connecting" | "open" | "lost", retryIn: number) => void;
  onDescription: (description: Description) => void;
  /** After a description, by which to solve it. */
  onTables?: (tables: Tables) => void;
  onFrame: (frame: Frame, arrival: number, size: number) => void;
  onMessage: (message: Record<string, any>) => void;
}

type StreamListeners = Partial<Listeners>;

interface StreamOptions {
  /** Frames per second that are asked for. */
  rate?: number;
  /** Of the playout [ms]. */
  delay?: number;
  /** Whether the wind alone is asked for, and the scene solved here. */
  byWind?: boolean;
  /** Scene that is solved here, of no server. */
  kept?: Kept | null;
}

interface Kept {
  description: Description;
  stand: import("./sway.js").Stand;
}

/** What a viewer may change. */
interface Control {
  name: string;
  label: string;
  description: string;
  unit: string;
  value: number | string | boolean | null;
  minimum: number | null;
  maximum: number | null;
  choices: string[];
  is_action: boolean;
}

// Of browsers with WebXR.

declare const XRWebGLLayer: any;
declare const XRRigidTransform: any;
interface Navigator {
  xr?: any;
}

// What is drawn.

type GL = WebGL2RenderingContext;
type Camera = import("./drawing/camera.js").Camera;
type Scene = import("./drawing/scene.js").Scene;
type TreeStream = import("./client.js").TreeStream;

interface Program {
  program: WebGLProgram;
  /** Sizes and locations of its inputs, as they are declared. */
  fields: { size: number; at: number }[];
  /** What sets each of them. */
  uniforms: Record<string, (value: any) => void>;
}

interface Drawable {
  vao: WebGLVertexArrayObject;
  /** Of its indices. */
  count: number;
  buffers: WebGLBuffer[];
}

interface Mesh {
  values: number[];
  indices: number[];
}

/** A motion sensor on the real tree. */
interface SensorStatus {
  /** With its place. */
  name?: string;
  /** Whether the tree follows it. */
  in_use?: boolean;
  /** Why not, and what to do. */
  problem?: string;
  /** What remains between it and the tree, over what is expected. */
  residual?: number;
  /** Samples per second [Hz]. */
  rate?: number;
  /** What was recognised, such as a unit. */
  notes?: string[];
}

/** Motion sensors, and the share of the motion that the wind alone explains. */
interface MotionStatus {
  sensors?: SensorStatus[];
  explained?: number;
  /** First frequency [Hz] that the sensors told, and the length of the motion behind it [h]. */
  learned?: { frequency: number; hours: number };
  /** Frequencies of the sway over those of some hours [h] before, less 1 [%]. */
  change?: { is_change: boolean; percent: number; hours: number };
  /** Where 80 % of the trees are that the real one may be, less the motion of the highest tip [m]. */
  band?: number[];
}

/** What the wind is, and for a live one its newest reading. */
interface WindStatus {
  kind?: string;
  name?: string;
  /** Samples per second [Hz]. */
  rate?: number;
  /** connecting, waiting, unknown (messages), live or stale. */
  state?: string;
  /** [m/s] */
  speed?: number;
  /** To east and north [m/s]. */
  wind?: number[];
  /** Of the reading [s]. */
  age?: number;
  /** Whether gusts are simulated about it. */
  is_mean?: boolean;
  lacks_direction?: boolean;
}

/** How much of a kind is drawn. */
interface Level {
  /** The first of its order. */
  branches: number;
  /** Of these. */
  segments: number;
  /** Of its leaves. */
  cards: number;
  /** Height of a tree that it is shaped for. */
  pixels: number;
  /** Height [px] from which on it is drawn. */
  from: number;
}

type Shape = ReturnType<typeof import("./drawing/mesh.js").shapeOf>;

/** Trees of a kind that are drawn on one level. */
interface DrawnLevel {
  /** Rows of their first segments, and their numbers among all trees. */
  starts: number[];
  numbers: number[];
  /** Parts, and what their programs are given; none of a picture. */
  bark?: Drawable;
  skin?: Record<string, any>;
  leaf?: Drawable;
  foliage?: Record<string, any>;
  impostor?: import("./drawing/impostors.js").Impostor;
}

/** A kind with the levels that have been used. */
type DrawnKind = Shape & { drawn: DrawnLevel[] };

/** What is below the trees. */
interface Ground {
  /** How it looks: 0 a terrace, 1 a meadow. */
  kind: number;
  /** Its height [m]. */
  ground: number;
  /** One over how far one sees [1/m]. */
  haze: number;
}

interface Daylight {
  /** Towards the sun, of length 1. */
  light: number[];
  /** Colour of its light. */
  sun: number[];
  /** Colour of the light of the sky. */
  sky: number[];
  zenith: number[];
  horizon: number[];
  /** Brightness of the ground. */
  dimmed: number;
}

/** How a species looks, see `Look` in tree_sway/core/tree/look.py. */
interface Look {
  /** Colours: red, green and blue from 0 to 1. Of a leaf, of the youngest. */
  green: number[];
  fresh: number[];
  /** Of a leaf before it falls; null of an evergreen. */
  autumn: number[] | null;
  bark: number[];
  twig: number[];
  bark_pattern: "furrows" | "plates" | "smooth" | "dashes" | "flakes" | "scales";
  form: "ovate" | "pointed" | "heart" | "lobed" | "palmate" | "compound" | "digitate" | "needles" | "tufts" | "fronds";
  /** Width of a leaf over its length. */
  slenderness: number;
  /** Of a leaf or a leaflet, or of a shoot with its needles [m]. */
  leaf_size: number;
  has_needles: boolean;
  /** How far shoots hang down; 1 is half-way. */
  droop?: number;
  /** Whether one alone stands in a pot. */
  is_potted: boolean;
  spray: Spray;
}

/** Cards that show a cluster of leaves: length over the cluster's size, width over length, and how far
 * each is turned about the shoot [rad]. */
interface Spray {
  length: number;
  width: number;
  rolls: number[];
}

/** Where grass grows, and what blows over it. */
interface Meadow {
  /** [m] */
  middle: number[];
  extent: number;
  /** Of the trees [m]. */
  height: number;
  /** Of the first tree, along the wind [m]. */
  first: number;
  /** Of the mean wind. */
  way: number[];
  /** Speed of the mean wind [m/s]. */
  mean: number;
  /** [s] */
  time: number;
}

/** Where leaves grow: a cluster, or what is drawn as one. */
interface Shoot {
  segment: number;
  /** Middle and frame (x y z w) at rest, in the frame of the tree; [m]. */
  at: number[];
  frame: number[];
  size: number;
  /** Of the flutter [rad], [Hz]. */
  phase: number;
  frequency: number;
  /** Of the cards of a cluster. */
  share: number;
}

/** Shapes turned about the vertical. */
interface Turned {
  sides: number;
  /** One of it beside each [m]. */
  middles: number[];
  /** Width over depth. */
  wide?: number;
  /** Radius, height [m] and colour. */
  profile: [number, number, string][];
}

/** Light within a crown. */
interface Shade {
  /** Share of the light of all directions that arrives, 0 to 1. */
  open: number;
  /** Where most of it comes from, shorter than 1. */
  towards: number[];
}

/** What a number is shown in. */
interface Unit {
  /** Values that it is for; all if left out. */
  below?: number;
  factor: number;
  unit: string;
  digits: number;
}

/** What is loaded when it is asked for. */
interface Hands {
  drag: import("./drag.js").Drag | null;
  sound: import("./sound.js").Sound | null;
  headset: import("./headset.js").Headset | null;
}

/** What one eye sees. */
interface View {
  camera: {
    matrix: Float32Array;
    eye: Vector;
    axes(): { right: number[]; up: number[]; back: number[] };
    update(): Float32Array;
  };
  target: WebGLFramebuffer | null;
  /** Of the target: x, y, width, height [px]. */
  area: number[];
}

/** A force at the root side of a segment, or a spring from it to a place. */
interface Recent {
  /** Of the frame that it was found at. */
  sequence: number;
  /** Mean wind of the anemometer, and its span [m/s, m/s, s]. */
  mean: number[];
  /** Of each tree [s]. */
  delay: number[];
  /** Its means over `SPACING`, three numbers each [m/s]. */
  wind: number[];
}

interface Push {
  /** Its number among those of all trees. */
  segment: number;
  /** [N] */
  force?: number[];
  /** [m] */
  to?: number[];
  /** Of the spring [N/m]; 0 lets go. */
  stiffness?: number;
}
