// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Types of messages, drawings and texts, for the type check of the JSDoc comments and for editors. */

// Messages: see doc/streaming.md.

type NumberArray = Float32Array | Int32Array | Int16Array | Uint8Array;
type Numbers = NumberArray | Float64Array | number[];
type Arrays = Record<string, { values: NumberArray; shape: number[] }>;
type Vector = [number, number, number];
/** Type and axes of arrays by name. */
type Forms = Record<string, ["f32" | "i32" | "i16" | "u8", ...(string | number)[]]>;

/** A kind of tree: everything that trees of one shape share. */
interface Kind {
  species: string;
  /** An average broadleaf if left out. */
  look?: Look;
  /** [m] */
  height: number;
  model: string;
  /** Largest error of a tip from the streamed coordinates alone [m]. */
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
  /** Index of its kind. */
  kind: number;
  /** [m] */
  height: number;
  /** x, y, z [m], rotation about the vertical [rad], scale. */
  place: number[];
  /** Where its own begin among those of all trees. */
  firstSegment: number;
  firstCoordinate: number;
  firstKey: number;
}

interface Description {
  name: string;
  frame_id: string;
  identity: string;
  /** The part of the identity that frames repeat. */
  shortIdentity: number;
  kinds: Kind[];
  trees: Tree[];
  /** Law of the flutter of leaves. */
  flutter: { gain: number; largest_angle: number } | null;
  /** Of all trees. */
  nSegments: number;
  nCoordinates: number;
  /** Value of each coordinate at full scale. */
  scale: Float32Array;
}

interface Frame {
  identity: number;
  sequence: number;
  /** Time on the sender's clock [ms]. */
  stamp: number;
  flags: number;
  /** Direction it blows to [m/s]. */
  wind: Vector;
  /** Streamed coordinates, then the numbers that `beyond` reads; empty in a frame of the wind alone. */
  coordinates: Float32Array;
  /** Index of the first of them. */
  first: number;
}

interface Tables {
  /** Identity of the description that they belong to. */
  description: string;
  /** Place of the anemometer [m]; upwind of all trees if null. */
  anemometer: number[] | null;
  /** Speed of gusts over that of the mean wind. */
  ratio: number;
  kinds: import("./sway.js").Table[];
  /** Wind speed at each tree over the wind of its kind. */
  speeds: ArrayLike<number>;
}

/** Callbacks of a connection. */
interface Listeners {
  onState: (state: "connecting" | "open" | "lost", retryIn: number) => void;
  onDescription: (description: Description) => void;
  /** After a description: tables to solve it by. */
  onTables?: (tables: Tables) => void;
  onFrame: (frame: Frame, arrival: number, size: number) => void;
  onMessage: (message: Record<string, any>) => void;
}

type StreamListeners = Partial<Listeners>;

interface StreamOptions {
  /** Frames per second to ask for. */
  rate?: number;
  /** Playout delay [ms]. */
  delay?: number;
  /** Whether to ask for the wind alone and solve the scene here. */
  byWind?: boolean;
  /** Scene of a page without a server, solved here. */
  kept?: Kept | null;
}

interface Kept {
  description: Description;
  stand: import("./sway.js").Stand;
}

/** A value that a viewer may change. */
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

// Globals of browsers with WebXR.

declare const XRWebGLLayer: any;
declare const XRRigidTransform: any;
interface Navigator {
  xr?: any;
}

// Drawing.

type GL = WebGL2RenderingContext;
type Camera = import("./drawing/camera.js").Camera;
type Scene = import("./drawing/scene.js").Scene;
type TreeStream = import("./client.js").TreeStream;

interface Program {
  program: WebGLProgram;
  /** Sizes and locations of the vertex inputs, in the order of their declaration. */
  fields: { size: number; at: number }[];
  /** Setter of each uniform. */
  uniforms: Record<string, (value: any) => void>;
}

interface Drawable {
  vao: WebGLVertexArrayObject;
  /** Number of indices. */
  count: number;
  buffers: WebGLBuffer[];
}

interface Mesh {
  values: number[];
  indices: number[];
}

/** Source of the wind, and the newest reading of a live one. */
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
  /** Age of the reading [s]. */
  age?: number;
  /** Whether gusts are simulated about it. */
  is_mean?: boolean;
  lacks_direction?: boolean;
}

/** Level of detail of a kind. */
interface Level {
  /** Number of branches, the first of the kind's order. */
  branches: number;
  /** Their segments. */
  segments: number;
  /** Cards of leaves. */
  cards: number;
  /** Height on the screen that its mesh is made for [px]. */
  pixels: number;
  /** Height on the screen from which on it is used [px]. */
  from: number;
}

type Shape = ReturnType<typeof import("./drawing/mesh.js").shapeOf>;

/** The trees of a kind that are drawn at one level. */
interface DrawnLevel {
  /** Rows of their first segments, and their numbers among all trees. */
  starts: number[];
  numbers: number[];
  /** Meshes and the values of their uniforms; absent where a picture is drawn. */
  bark?: Drawable;
  skin?: Record<string, any>;
  leaf?: Drawable;
  foliage?: Record<string, any>;
  impostor?: import("./drawing/impostors.js").Impostor;
}

/** A kind with the levels made so far. */
type DrawnKind = Shape & { drawn: DrawnLevel[] };

/** Ground below the trees. */
interface Ground {
  /** 0 a terrace, 1 a meadow. */
  kind: number;
  /** Its height [m]. */
  ground: number;
  /** Inverse of the visual range [1/m]. */
  haze: number;
  /** Place of the first tree, one over the radius of the trees and of its stem or pot [1/m]. */
  stem: number[];
}

interface Daylight {
  /** Unit vector towards the sun. */
  light: number[];
  /** Colour of sunlight. */
  sun: number[];
  /** Colour of the light of the sky. */
  sky: number[];
  zenith: number[];
  horizon: number[];
  /** Brightness of the ground. */
  dimmed: number;
}

/** Look of a species, see `Look` in tree_sway/core/species/look.py. */
interface Look {
  /** Colour of a leaf, and of a young one: red, green, blue from 0 to 1. */
  green: number[];
  fresh: number[];
  /** Colour of a leaf before it falls; null for evergreens. */
  autumn: number[] | null;
  bark: number[];
  twig: number[];
  bark_pattern: "furrows" | "plates" | "smooth" | "dashes" | "flakes" | "scales";
  form: "ovate" | "pointed" | "heart" | "lobed" | "palmate" | "compound" | "digitate" | "needles" | "bunches" | "tufts" | "fronds";
  /** Width of a leaf over its length. */
  slenderness: number;
  /** Length of a leaf or leaflet, or of a shoot with needles [m]. */
  leaf_size: number;
  has_needles: boolean;
  /** How far shoots hang: 0 not at all, 1 half-way down. */
  droop?: number;
  /** Depth of a cluster over its width: small where leaves lie in layers. */
  depth?: number;
  /** Whether a single tree stands in a pot. */
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

/** The meadow, and the wind over it. */
interface Meadow {
  /** Middle and extent of the trees [m]. */
  middle: number[];
  extent: number;
  /** Height of the trees [m]. */
  height: number;
  /** Place of the tree farthest upwind, along the wind [m]. */
  first: number;
  /** Unit vector of the mean wind. */
  way: number[];
  /** Speed of the mean wind [m/s]. */
  mean: number;
  /** [s] */
  time: number;
}

/** A shoot with leaves: a cluster of the description, or one that is only drawn. */
interface Shoot {
  segment: number;
  /** Middle [m] and orientation (x y z w) at rest, in the frame of the tree. */
  at: number[];
  frame: number[];
  size: number;
  /** Phase [rad] and frequency [Hz] of its flutter. */
  phase: number;
  frequency: number;
  /** Cards of it over those of a cluster. */
  share: number;
}

/** A solid of revolution about the vertical. */
interface Turned {
  sides: number;
  /** Offsets of its copies to the side [m]. */
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

/** Unit in which a number is shown. */
interface Unit {
  /** Upper end of the values that it is for; all if left out. */
  below?: number;
  factor: number;
  unit: string;
  digits: number;
}

/** Modules that are loaded when they are first used. */
interface Hands {
  drag: import("./drag.js").Drag | null;
  sound: import("./sound.js").Sound | null;
  headset: import("./headset.js").Headset | null;
  film: import("./hand_camera.js").HandCamera | null;
}

/** View of one eye. */
interface View {
  camera: {
    matrix: Float32Array;
    eye: Vector;
    axes(): { right: number[]; up: number[]; back: number[] };
    update(): Float32Array;
  };
  target: WebGLFramebuffer | null;
  /** Part of the target: x, y, width, height [px]. */
  area: number[];
}

/** Wind of the last minute on a server, so that gusts under way arrive here too. */
interface Recent {
  /** Number of the frame that it belongs to. */
  sequence: number;
  /** Mean wind of the anemometer, and its span [m/s, m/s, s]. */
  mean: number[];
  /** Delay of each tree [s]. */
  delay: number[];
  /** Its means over `SPACING`, three numbers each [m/s]. */
  wind: number[];
}

/** A force on the root-side end of a segment, or a spring from there to a place. */
interface Push {
  /** Its number among the segments of all trees. */
  segment: number;
  /** [N] */
  force?: number[];
  /** [m] */
  to?: number[];
  /** Of the spring [N/m]; 0 ends the pull. */
  stiffness?: number;
}
