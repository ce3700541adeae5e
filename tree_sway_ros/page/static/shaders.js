// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Programs of the graphics unit. Poses lie in a texture, two texels per segment. */

export const TEXTURE_WIDTH = 1024;
/** Trees that are drawn in one go at most: many small ones cost little more than one. */
export const MOST_COPIES = 32;
/** Start of no tree. */
export const NOTHING = 0xffffffff;

const POSE = `#version 300 es
precision highp float;
precision highp int;
uniform mat4 camera;
uniform float ground;
uniform vec3 light;
uniform vec3 eye;
uniform vec4 shadowArea; // middle x, y, one over half its size, 1 when the shadow is drawn
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec4 seen(vec3 p) {
  if (shadowArea.w < 0.5) return camera * vec4(p, 1.0);
  vec2 flat_ = p.xy - light.xy / light.z * (p.z - ground);
  return vec4((flat_ - shadowArea.xy) * shadowArea.z, 0.0, 1.0);
}
`;

/** What hangs on a segment: its pose, and the scale of its tree. */
const HUNG = `${POSE}
uniform highp sampler2D poses;
uniform uvec4 starts[${MOST_COPIES / 4}]; // rows of the first segments of the trees of a batch
in uint segment; // of its tree, and in the upper byte which tree of the batch
uint start() { return starts[segment >> 26][(segment >> 24) & 3u]; }
uint rowOf() { return 2u * (start() + (segment & 0xffffffu)); }
vec4 seenIfAny(vec3 p) { return start() == ${NOTHING}u ? vec4(2.0, 2.0, 2.0, 1.0) : seen(p); }
vec4 texel(uint at) { return texelFetch(poses, ivec2(int(at & 1023u), int(at >> 10)), 0); }
`;

/** What is lit; the shadow is its outline. */
const LIT = `#version 300 es
precision highp float;
in vec3 normal;
uniform vec3 light;
uniform float isShadow;
out vec4 color;
`;

export const BARK_VERTEX = `${HUNG}
in vec4 ring; // along, across y, across z, thickness; of a ribbon: along, across, 0, thickness - 2
out vec3 normal;
out float thickness;
void main() {
  uint row = rowOf();
  vec4 root = texel(row);
  vec4 q = texel(row + 1u);
  vec3 p = root.xyz;
  vec3 axis = turned(q, vec3(1.0, 0.0, 0.0));
  p += root.w * ring.x * axis;
  thickness = ring.w;
  if (ring.w < -0.5) {
    // What is too thin to be seen round faces whoever looks, the sun for the shadow.
    vec3 back = normalize(shadowArea.w < 0.5 ? eye - p : light);
    vec3 across = normalize(cross(back, axis) + vec3(0.0, 0.0, 1e-6));
    p += root.w * ring.y * across;
    normal = back + sign(ring.y) * across;
    thickness += 2.0;
  } else {
    vec3 across = turned(q, vec3(0.0, ring.yz));
    p += root.w * across;
    normal = across;
  }
  gl_Position = seenIfAny(p);
}`;

export const BARK_FRAGMENT = `${LIT}
in float thickness;
uniform vec3 barkColor;
uniform vec3 twigColor;
void main() {
  if (isShadow > 0.5) { color = vec4(1.0); return; }
  vec3 n = normalize(normal);
  float lit = max(dot(n, light), 0.0);
  float sky = 0.5 + 0.5 * n.z;
  vec3 base = mix(twigColor, barkColor, thickness);
  color = vec4(base * (0.34 + 0.28 * sky + 0.62 * lit), 1.0);
}`;

export const LEAF_VERTEX = `${HUNG}
in vec3 centre;
in vec4 orientation; // w x y z
in vec3 place;
in vec3 facing;
in vec3 flutter; // frequency, phase, shade
uniform float time;
uniform float speed;
uniform vec2 law; // gain, largest angle
uniform float swell; // where fewer leaves are drawn, larger ones
out vec3 normal;
out float shade;
void main() {
  uint row = rowOf();
  vec4 root = texel(row);
  vec4 q = texel(row + 1u);
  float a = law.y * tanh(law.x * speed * speed / (flutter.x * law.y));
  a *= sin(6.2831853 * flutter.x * time + flutter.y);
  float c = cos(a);
  float s = sin(a);
  vec3 local = vec3(place.x, c * place.y - s * place.z, s * place.y + c * place.z);
  vec3 face = vec3(facing.x, c * facing.y - s * facing.z, s * facing.y + c * facing.z);
  vec4 own = orientation.yzwx;
  vec3 p = root.xyz + root.w * turned(q, centre + turned(own, swell * local));
  normal = turned(q, turned(own, face));
  shade = flutter.z;
  gl_Position = seenIfAny(p);
}`;

export const LEAF_FRAGMENT = `${LIT}
in float shade;
uniform vec3 leafColor;
uniform vec3 freshColor;
void main() {
  if (isShadow > 0.5) { color = vec4(1.0); return; }
  vec3 n = normalize(normal);
  float across = dot(n, light);
  float lit = max(across, 0.0) + 0.55 * max(-across, 0.0);
  vec3 base = mix(leafColor, freshColor, 0.45 * shade + 0.25 * max(-across, 0.0));
  float sheen = 0.12 * pow(abs(across), 12.0);
  color = vec4(base * shade * (0.5 + 0.72 * lit) + sheen * shade, 1.0);
}`;

export const SOLID_VERTEX = `${POSE}
in vec3 at;
in vec3 facing;
in vec3 tint;
uniform vec4 placed; // x, y, z, scale
uniform vec2 heading; // cosine and sine about the vertical
out vec3 normal;
out vec3 base;
void main() {
  vec3 p = at * placed.w;
  p = vec3(heading.x * p.x - heading.y * p.y, heading.y * p.x + heading.x * p.y, p.z) + placed.xyz;
  normal = vec3(heading.x * facing.x - heading.y * facing.y,
    heading.y * facing.x + heading.x * facing.y, facing.z);
  base = tint;
  gl_Position = seen(p);
}`;

export const SOLID_FRAGMENT = `${LIT}
in vec3 base;
void main() {
  if (isShadow > 0.5) { color = vec4(1.0); return; }
  vec3 n = normalize(normal);
  float lit = max(dot(n, light), 0.0);
  color = vec4(base * (0.45 + 0.2 * n.z + 0.55 * lit), 1.0);
}`;

// The ground fades from vertex to vertex: its pixels are many and must cost nothing.
export const GROUND_VERTEX = `#version 300 es
precision highp float;
uniform mat4 camera;
uniform vec4 area; // middle x, y, half its size, height
uniform vec3 groundColor;
uniform vec3 backColor;
in vec2 corner;
out vec3 base;
void main() {
  base = mix(groundColor, backColor, smoothstep(0.3, 1.0, length(corner)));
  gl_Position = camera * vec4(area.xy + corner * area.z, area.w, 1.0);
}`;

export const GROUND_FRAGMENT = `#version 300 es
precision mediump float;
in vec3 base;
out vec4 color;
void main() { color = vec4(base, 1.0); }`;

export const SHADOW_VERTEX = `#version 300 es
precision highp float;
uniform mat4 camera;
uniform vec4 area;
in vec2 corner;
out vec2 at;
void main() {
  at = 0.5 + 0.5 * corner;
  gl_Position = camera * vec4(area.xy + corner * area.z, area.w, 1.0);
}`;

export const SHADOW_FRAGMENT = `#version 300 es
precision mediump float;
in vec2 at;
uniform sampler2D shadow;
uniform float softness; // 0 where every pixel counts
out vec4 color;
void main() {
  float dark = texture(shadow, at).r;
  if (softness > 0.0) {
    dark = 0.4 * dark + 0.15 * (texture(shadow, at + vec2(softness, 0.0)).r
      + texture(shadow, at - vec2(softness, 0.0)).r
      + texture(shadow, at + vec2(0.0, softness)).r
      + texture(shadow, at - vec2(0.0, softness)).r);
  }
  if (dark < 0.01) discard;
  color = vec4(0.0, 0.0, 0.0, 0.4 * dark);
}`;
