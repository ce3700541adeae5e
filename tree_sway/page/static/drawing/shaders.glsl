// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
// Shaders in parts: `#part NAME BASE` begins one, which `gl.js` compiles after its base. Poses come from a
// texture, two texels per segment.

#part tones
precision highp float;
precision highp int;
// Tones of light: full sun is held back, as in a photograph.
vec3 toned(vec3 c) { return 2.6 * c / (c + 1.6); }
uniform vec4 stem; // of the first tree: place, one over the radius of the trees and of the stem or the pot
// Share of the light of the sky that reaches the ground: less under a crown, least beside a stem.
float skyAt(vec2 p) {
  vec2 far = distance(p, stem.xy) * stem.zw;
  return (0.72 + 0.28 * smoothstep(0.0, 1.3, far.x)) * (1.0 - 0.66 * exp(-0.12 * far.y * far.y));
}

#part seen noise
uniform mat4 camera;
uniform float ground;
uniform vec3 light; // towards the sun
uniform vec3 sun; // colours
uniform vec3 sky;
uniform vec3 eye;
uniform float haze; // inverse of the visual range [1/m]
uniform vec4 shadowArea; // middle x, y, one over half its size, 1 when the shadow is drawn
uniform float shadowTop; // inverse of the height of the trees [1/m]
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
// Place of a point's shadow in the shadow map, and the depth of the point from the sun.
vec3 fallen(vec3 p) {
  vec2 flat_ = p.xy - light.xy / light.z * (p.z - ground);
  return vec3((flat_ - shadowArea.xy) * shadowArea.z, 1.0 - 2.0 * clamp((p.z - ground) * shadowTop, 0.0, 1.0));
}
vec4 seen(vec3 p) {
  if (shadowArea.w < 0.5) return camera * vec4(p, 1.0);
  return vec4(fallen(p), 1.0);
}
float clearness(vec3 p) { float far = haze * distance(eye, p); return 1.0 / (1.0 + far + 0.5 * far * far); }

#part sunlit seen
uniform mediump sampler2DShadow sunMap;
vec3 inSunMap(vec3 p) { return 0.5 + 0.5 * fallen(p) - vec3(0.0, 0.0, 0.12 * sqrt(shadowTop)); }
// Share of sunlight that reaches a point, and the same filtered over two places beside it, which are turned by an angle.
float sunlight(vec3 p) { return texture(sunMap, inSunMap(p)); }
float sunlight(vec3 p, float soft, float turn) {
  vec3 at = inSunMap(p);
  vec3 a = soft * vec3(cos(turn), sin(turn), 0.0);
  return 0.5 * (texture(sunMap, at + a) + texture(sunMap, at - a));
}

#part hung sunlit
// Vertices that belong to a segment: its pose, and the scale of its tree.
uniform highp sampler2D poses;
uniform float start; // row of the first segment of its tree
in float segment; // of its tree
uint rowOf() { return 2u * uint(start + segment); }
vec4 texel(uint at) { return texelFetch(poses, ivec2(int(at & 1023u), int(at >> 10)), 0); }

#part noise tones
float hash(vec2 p) {
  uvec2 q = uvec2(ivec2(p)) * uvec2(1597334673u, 3812015801u);
  uint n = (q.x ^ q.y) * 1597334673u;
  return float(n >> 8) / 16777216.0;
}
// Smooth noise, 0 to 1; it repeats after a number of cells each way.
float tiled(vec2 p, vec2 cells) {
  vec2 i = mod(floor(p), cells);
  vec2 j = mod(i + 1.0, cells);
  vec2 f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(vec2(j.x, i.y)), f.x), mix(hash(vec2(i.x, j.y)), hash(j), f.x), f.y);
}
float noise(vec2 p) { return tiled(p, vec2(65536.0)); }
// Noise of a cell size [m], which fades out where a pixel is larger.
float grain(vec2 p, float size, float pixel) {
  float shown = 1.0 - smoothstep(0.25, 0.8, pixel / size);
  return shown > 0.0 ? shown * (noise(p / size) - 0.5) : 0.0;
}

// Share of bare earth, which lies under a crown.
float worn(vec2 p) {
  float far = distance(p, stem.xy) * stem.z;
  if (far > 0.9) return 0.0;
  return 1.0 - smoothstep(0.12, 0.5, far + 0.5 * (noise(p / 0.9) - 0.5) + 0.3 * (noise(p / 0.23) - 0.5));
}
// Colour of the meadow, and how lush it is, 0 to 1: patches of lush and of dry grass, clover, moss. Small ones fade out
// where a pixel is larger.
vec4 meadow(vec2 p, float bare, float pixel) {
  float broad = 0.6 * noise(p / 23.0) + 0.4 * noise(p / 6.1 + 9.0);
  float clumps = 0.5 + (0.6 * noise(p / 1.9) + 0.4 * noise(p / 0.7 + 5.0) - 0.5) / (1.0 + pixel * pixel);
  float dry = smoothstep(0.3, 0.95, 0.7 * broad + 0.4 * clumps);
  vec3 grass = mix(vec3(0.3, 0.39, 0.18), vec3(0.49, 0.5, 0.29), dry);
  grass = mix(grass, vec3(0.27, 0.38, 0.2), 0.7 * smoothstep(0.5, 0.75, noise(p / 3.7 + 40.0)) / (1.0 + 0.3 * pixel));
  grass *= 0.8 + 0.4 * clumps;
  return vec4(mix(grass, vec3(0.37, 0.34, 0.23) * (0.8 + 0.4 * clumps), 0.5 * bare), clumps * (1.0 - 0.5 * dry));
}

#part lit noise
// Lit surfaces; for the shadow only their outline is drawn.
uniform float isShadow;
uniform vec3 horizon;
out vec4 color;

#part bark.vertex hung
in vec4 ring; // along, across y, across z, thickness; of a ribbon: along, across, up, thickness - 2
in vec3 skin; // place on the bark, how open to the sky
uniform vec2 picked; // rows of the first and last segment of the highlighted branch
out vec3 normal;
out vec2 at;
out vec3 tone; // thickness, openness, clearness
out float mark;
#ifdef PLAIN
out float sunny;
#else
out vec3 inMap; // place in the shadow map
#endif
out float high; // height over the ground, 1 at the top of the scene
void main() {
  uint row = rowOf();
  vec4 root = texel(row);
  vec4 q = texel(row + 1u);
  vec3 p = root.xyz;
  vec3 axis = turned(q, vec3(1.0, 0.0, 0.0));
  p += root.w * ring.x * axis;
  float thickness = ring.w;
  if (ring.w < -0.5) {
    // A ribbon faces the eye, or the sun for the shadow, and bends upwards or downwards.
    p += root.w * ring.z * turned(q, vec3(0.0, 0.0, 1.0));
    vec3 back = normalize(shadowArea.w < 0.5 ? eye - p : light);
    vec3 across = normalize(cross(back, axis) + vec3(0.0, 0.0, 1e-6));
    p += root.w * ring.y * across;
    normal = back + sign(ring.y) * across;
    thickness += 2.0;
  } else {
    vec3 across = turned(q, vec3(0.0, ring.yz));
    // A stem flares into its roots at its foot; the shadow is wider still there, where the sky is hidden too.
    float foot = max(0.0, 1.0 - 14.0 * (p.z - ground) * shadowTop) * step(0.9, thickness);
    // Wood swells and narrows along its way and about it.
    float knobbly = 0.08 * sin(6.2831853 * skin.x + 2.6 * sin(0.9 * skin.y)) + 0.03 * sin(3.7 * skin.y + 0.7 * segment);
    p += root.w * (1.0 + min(thickness, 1.0) * knobbly + 1.6 * step(0.5, shadowArea.w) * foot) * across;
    normal = across;
  }
  at = skin.xy;
  tone = vec3(thickness, skin.z, clearness(p));
  float own = 0.5 * float(row);
  mark = own > picked.x - 0.5 && own < picked.y + 0.5 ? 1.0 : 0.0;
#ifdef PLAIN
  sunny = shadowArea.w < 0.5 ? sunlight(p) : 1.0;
#else
  inMap = inSunMap(p);
#endif
  high = (p.z - ground) * shadowTop;
  gl_Position = seen(p);
}

#part bark.fragment lit
in vec3 normal;
in vec2 at;
in vec3 tone;
in float mark;
#ifdef PLAIN
in float sunny;
#else
in vec3 inMap;
uniform mediump sampler2DShadow sunMap;
#endif
in float high;
uniform vec3 light;
uniform vec3 sun;
uniform vec3 sky;
uniform vec3 barkColor;
uniform vec3 footColor; // colour of the bark at the foot of the stem
uniform float footHeight; // its height, 1 at the top of the scene
uniform vec3 twigColor;
uniform vec4 paint; // colour of the whole tree, and its opacity
uniform sampler2D relief; // factor of the colour of the bark, twice as high as wide
void main() {
  if (isShadow > 0.5) { color = vec4(1.0 - 0.7 * min(high, 1.0)); return; }
  vec3 n = normalize(normal);
  vec3 rough = texture(relief, at * vec2(1.0, 0.5)).rgb;
#ifndef PLAIN
  if (tone.x > 0.4) {
    // Ridges of thick wood have a bright and a dark side, and an upper and a lower one.
    float slope = rough.r - texture(relief, (at + vec2(0.03, 0.0)) * vec2(1.0, 0.5)).r;
    float rise = rough.r - texture(relief, (at + vec2(0.0, 0.03)) * vec2(1.0, 0.5)).r;
    n = normalize(n + tone.x * (4.5 * slope * normalize(vec3(-n.y, n.x, 1e-3)) + vec3(0.0, 0.0, 2.0 * rise)));
  }
#endif
  vec3 own = barkColor;
  if (footHeight > 0.0) {
    // Rifts of it reach up between the bark above.
    float up = high / footHeight + 1.6 * (noise(at * vec2(9.0, 1.4)) - 0.5);
    own = mix(footColor, barkColor, smoothstep(0.66, 0.78, up));
  }
#ifndef PLAIN
  // Weather and moss: stains as long as the stem is wide, the greener the nearer to the ground.
  float stain = noise(vec2(3.0 * normal.x, 0.5 * at.y + 2.0 * normal.y));
  own *= mix(vec3(1.08, 1.05, 0.98), vec3(0.62, 0.68, 0.5) + 0.3 * min(1.0, 4.0 * high), stain);
  if (tone.x > 0.1) {
    // Lumps, scars and lichens, each of its own size; noise about the stem has no seam.
    vec2 about = 6.0 * normal.xy;
    float lumps = noise(about + vec2(0.0, 1.1 * at.y)) + noise(about.yx * 2.3 + vec2(1.7 * at.y, 5.0));
    float fine = noise(about * 7.0 + vec2(0.0, 9.0 * at.y)) + noise(about.yx * 15.0 + vec2(31.0 * at.y, 3.0));
    own *= 0.5 + 0.3 * lumps + 0.2 * fine;
    own = mix(own, vec3(0.5, 0.53, 0.43), 0.45 * smoothstep(1.2, 1.5, lumps + 0.35 * (fine - 1.0)));
    n = normalize(n + 0.6 * tone.x * vec3(lumps - 1.0, 0.7 * (fine - 1.0), 0.5 * (lumps - fine)));
  }
#endif
  vec3 base = mix(twigColor, own * (0.05 + 0.95 * rough * (0.4 + 0.6 * rough)), tone.x);
  base = mix(base, paint.rgb, paint.a);
  // Within the crown, at the foot among grass, and where a limb joins another, bark is dark.
  float open = (0.28 + 0.72 * smoothstep(0.05, 1.0, tone.y)) * (0.4 + 0.6 * smoothstep(0.0, 0.05, high)) * (0.72 + 0.28 * smoothstep(0.1, 0.7, at.y));
#ifdef PLAIN
  float shone = sunny;
#else
  // Spots of sun between the leaves above.
  float shone = 0.5 * (texture(sunMap, inMap) + texture(sunMap, inMap + vec3(0.002, 0.001, 0.0)));
#endif
  vec3 lit = open * (sky * (0.72 + 0.28 * n.z) + sun * shone * max(dot(n, light), 0.0) * (0.5 + 0.5 * tone.x));
  base = mix(base * toned(lit), vec3(1.0, 0.45, 0.1), 0.75 * mark);
  color = vec4(mix(horizon, base, tone.z), 1.0);
}

#part leaf.vertex hung
in vec3 place;
in vec3 swing; // displacement per unit of its flutter
in vec3 facing;
in vec3 towards; // direction of most of the light within the crown
in vec4 flutter; // frequency, phase, openness, tint
in vec2 corner;
uniform float time;
uniform float speed;
uniform vec2 law; // gain, largest angle
uniform float isBaked;
uniform vec3 dulled; // colour of a crown in the open over that of a leaf alone
uniform vec3 unturned; // colour of a leaf before autumn over that of the picture
uniform float gloss; // specular reflection, 0 for a dull leaf
uniform vec3 horizon;
uniform vec4 paint; // colour of the whole tree, and its opacity
out vec2 at;
out vec3 lit; // factor of the colour of the leaf
flat out vec3 veil; // added colour: haze, paint, specular reflection
flat out float edge; // share of the card that is drawn: less where it is seen edge-on, as a line
const float WAX = 0.03; // share of light that the surface of a leaf reflects, in the colour of the light
void main() {
  uint row = rowOf();
  vec4 root = texel(row);
  vec4 q = texel(row + 1u);
  edge = 1.0;
  lit = vec3(0.0);
  // A cheap approximation of the hyperbolic tangent in the law.
  float wild = law.x * speed * speed / (flutter.x * law.y);
  float a = law.y * wild * inversesqrt(1.0 + wild * wild) * sin(6.2831853 * flutter.x * time + flutter.y);
  vec3 p = root.xyz + root.w * turned(q, place + a * swing);
  at = corner;
  gl_Position = seen(p);
  // In the shadow: the lower, the brighter.
  veil = vec3(1.0 - 0.7 * min(1.0, (p.z - ground) * shadowTop));
  if (shadowArea.w > 0.5) return;
  vec3 outward = turned(q, towards);
  vec3 flat_ = turned(q, facing);
  vec3 back = normalize(eye - p);
#ifdef PLAIN
  edge = min(1.0, 4.0 * abs(dot(flat_, back)));
  float own = 0.3;
  const float least = 0.3; // of the sun: few cards for many leaves hide more of it than these would
#else
  edge = min(1.0, 1.6 * abs(dot(flat_, back)));
  float own = 1.8;
  const float least = 0.12;
#endif
  // Leaves are lit by the normal of the crown more than by their own, so that the crown looks round.
  vec3 n = normalize(own * flat_ * sign(dot(flat_, outward) + 1e-6) + outward);
  float side = dot(flat_, back) < 0.0 ? -1.0 : 1.0;
  float across = dot(n, light);
  float open = flutter.z;
  // Leaves deep in the crown are darker than those at its surface, but are lit by other leaves.
  float near = smoothstep(0.0, 0.8, open);
  // Each leaf samples the shadow at places of its own, so that its border is a mixture of light and dark leaves.
  // The far side of the crown has little sun, whatever the shadow of its few leaves lets through.
  float turnedTo = smoothstep(-1.3, 1.5, dot(outward, light));
  float sunny = mix(least, 1.0, sunlight(p, 0.007, 3.0 * flutter.y)) * (0.12 + 0.88 * near);
  // Light that other leaves have passed on is green.
  vec3 up = sky * mix(vec3(0.42, 0.44, 0.33), vec3(1.05, 1.1, 0.95), near) * (0.66 + 0.34 * n.z) * (0.85 + 0.15 * turnedTo);
  // Light through a leaf is yellow, and is seen most against the sun.
  vec3 through = vec3(1.4, 1.6, 0.5) * max(-side * dot(flat_, light), 0.0) * (0.9 - 0.5 * turnedTo);
  vec3 direct = sun * sunny * ((0.1 + 0.9 * turnedTo) * (0.13 + 2.2 * max(0.75 * across + 0.25, 0.0)) + through);
  // Greens vary, from leaf to leaf and from cluster to cluster; young ones at the rim of the crown are lighter. In
  // autumn shaded leaves, and some others, turn last.
  vec3 spot = 9.0 * shadowTop * p;
  float limb = 0.5 * (sin(spot.x + 1.7 * spot.z) + sin(spot.y - 1.3 * spot.z + 1.0));
  vec3 hue = dulled * (1.0 + 0.05 * sin(9.0 * flutter.y) + vec3(0.05, 0.0, -0.06) * (0.7 * sin(5.0 * flutter.y) + 0.3 * limb));
  hue += (0.5 * (flutter.w - 1.0) + 0.12 * max(0.0, near - 0.7)) * vec3(0.35, 0.2, -0.2);
  float late = smoothstep(0.1, 1.0, 0.75 - open + 0.35 * sin(3.0 * flutter.y) + 0.25 * sin(8.0 * flutter.y) + 0.35 * limb);
  hue *= mix(vec3(1.0), unturned, late) * (1.0 + (1.0 - unturned) * vec3(0.25, -0.8, 0.4) * (0.35 * sin(2.0 * flutter.y) - 0.4 * limb));
  float shine = gloss > 0.0 ? gloss * sunny * pow(max(side * dot(flat_, normalize(light + back)), 0.0), 12.0) : 0.0;
  vec3 shone = isBaked > 0.5 ? vec3(0.5 + 0.5 * open) : toned(up + direct);
  vec3 whole = hue * flutter.w * shone;
  float clear = clearness(p);
  lit = clear * (1.0 - paint.a) * whole;
  veil = (1.0 - clear) * horizon + clear * (paint.a * paint.rgb * whole + WAX * shone + shine);
}

#part leaf.fragment
#ifdef PLAIN
precision mediump float;
#else
precision highp float;
#endif
in vec2 at;
in vec3 lit;
flat in vec3 veil;
flat in float edge;
uniform sampler2D leaves;
uniform vec3 woody; // colour of a twig, which lies beside the picture
out vec4 color;
void main() {
#ifndef PLAIN
  if (at.x < -0.5) { color = vec4(woody * lit + veil, edge); return; }
#endif
  vec4 leaf = texture(leaves, at);
#ifdef PLAIN
  // Without a graphics unit every operation counts; `chosenTexture` has made the random choice.
  if (edge * leaf.a < 0.25) discard;
  color = vec4(leaf.rgb * lit + veil, 1.0);
#else
  // From afar a point of the picture covers leaves and gaps: it is drawn at random, so that no card looks like one
  // large leaf.
  float small = length(fwidth(at));
  float cells = exp2(floor(0.5 - log2(small)));
  float chance = fract(43758.5453 * sin(dot(floor(at * cells), vec2(12.9898, 78.233))));
  // Sooner in a large picture, which has many leaves, than in that of a single one.
  float points = float(textureSize(leaves, 0).x);
  float mixed = min(1.0, 0.22 * max(0.0, log2(4.5e-4 * points * points * small)));
  float least = mix(0.5, 0.1 + 0.68 * chance, mixed);
  float shown = edge * leaf.a;
  // The rim of a leaf covers a part of its pixel.
  float cover = clamp(0.5 + (shown - least) / max(fwidth(shown), 0.02 + 0.6 * mixed), 0.0, 1.0);
  if (cover < 0.05) discard;
  float own = 1.0 + 0.34 * (fract(17.0 * chance) - 0.5) * mixed;
  color = vec4(leaf.rgb * own / max(leaf.a, 0.01) * lit + veil, cover);
#endif
}

#part impostor.vertex seen
// A far tree: a picture of its kind that faces the eye and leans with the top of the tree.
uniform highp sampler2D poses;
uniform vec4 box; // half its width, middle height and full height [m], shade at the foot
uniform vec3 restTip;
uniform vec3 horizon;
in vec2 corner;
in vec4 stand; // x, y, z, yaw
in vec3 tree; // scale, row of the top, tint
in vec4 paint;
out vec2 at;
out vec3 lit; // factor of the picture's colour
flat out vec3 veil; // the haze that is added
flat out vec3 painted; // colour of paint, shaded as the picture is
void main() {
  float scale = tree.x;
  // A shrub is the top of a tree, and stands still.
  bool isShrub = tree.y < 0.0;
  vec2 place = isShrub ? vec2(corner.x, max(corner.y, 0.1)) : corner;
  vec3 middle = stand.xyz + vec3(0.0, 0.0, box.y * scale);
  vec3 back = shadowArea.w < 0.5 ? normalize(eye - middle) : light;
  vec2 to = normalize(back.xy + vec2(1e-5, 0.0));
  float view = floor((atan(to.y, to.x) - stand.w) * float(ROUND) / 6.2831853 + 0.5);
  float high = back.z > sin(0.5 * (LOW + HIGH)) ? 1.0 : 0.0;
  float e = mix(LOW, HIGH, high);
  vec3 right = vec3(-to.y, to.x, 0.0);
  vec3 up = vec3(-sin(e) * to, cos(e));
  float tall = 0.5 * box.z * cos(e) + box.x * sin(e);
  vec3 p = middle + scale * (place.x * box.x * right + place.y * tall * up);
  uint row = 2u * uint(max(0.0, tree.y));
  vec3 tip = texelFetch(poses, ivec2(int(row & 1023u), int(row >> 10)), 0).xyz;
  vec2 turn = vec2(cos(stand.w), sin(stand.w));
  vec3 rest = vec3(turn.x * restTip.x - turn.y * restTip.y, turn.y * restTip.x + turn.x * restTip.y,
    restTip.z);
  float h = clamp((p.z - stand.z) / (box.z * scale), 0.0, 1.1);
  if (!isShrub) p += (tip - stand.xyz - scale * rest) * h * h;
  vec3 n = normalize(place.x * right + 0.8 * place.y * up + 0.6 * vec3(cos(e) * to, sin(e)));
  float shade = mix(box.w, 1.0, min(1.0, 1.25 * h)) * tree.z;
  float clear = clearness(p);
  vec3 whole = clear * shade * toned(sky * (0.9 + 0.3 * n.z) + sun * max(0.0, 0.7 + 1.4 * dot(n, light)));
  bool isShadow = shadowArea.w > 0.5;
  lit = isShadow ? vec3(0.0) : (1.0 - paint.a) * whole;
  veil = isShadow ? vec3(1.0) : (1.0 - clear) * horizon;
  painted = isShadow ? vec3(0.0) : 2.2 * paint.a * paint.rgb * whole;
  at = (vec2(mod(view, float(ROUND)), high) + 0.5 + 0.5 * place) / vec2(float(ROUND), 2.0);
  gl_Position = seen(p);
}

#part impostor.fragment
precision mediump float;
in vec2 at;
in vec3 lit;
flat in vec3 veil;
flat in vec3 painted;
uniform sampler2D picture;
out vec4 color;
void main() {
  vec4 seen = texture(picture, at);
  if (seen.a < 0.15) discard;
  color = vec4(seen.rgb * lit + max(seen.r, seen.g) * painted + veil, 1.0);
}

#part solid.vertex seen
in vec3 at;
in vec3 facing;
in vec3 tint;
uniform vec4 placed; // x, y, z, scale
uniform vec2 heading; // cosine and sine about the vertical
out vec4 base;
void main() {
  vec3 p = at * placed.w;
  p = vec3(heading.x * p.x - heading.y * p.y, heading.y * p.x + heading.x * p.y, p.z) + placed.xyz;
  vec3 n = normalize(vec3(heading.x * facing.x - heading.y * facing.y,
    heading.y * facing.x + heading.x * facing.y, facing.z));
  // Less light of the sky comes near the ground.
  float open = 0.6 + 0.4 * clamp(2.5 * (p.z - ground) / placed.w, 0.0, 1.0);
  base = vec4(tint * open * toned(sky * (0.75 + 0.25 * n.z) + sun * max(dot(n, light), 0.0)), clearness(p));
  gl_Position = seen(p);
}

#part solid.fragment lit
in vec4 base;
void main() {
  color = isShadow > 0.5 ? vec4(1.0) : vec4(mix(horizon, base.rgb, base.a), 1.0);
}

#part grass.vertex sunlit
in vec4 blade; // place and height over the size of the meadow, a random number
in float corner; // left, right, or 0 at the tip
uniform vec4 field; // middle, radius, height of the grass
uniform vec4 downwind; // direction of the wind, the first tree and the last place along it [m]
uniform float gusts[PLACES];
uniform float time;
uniform float dimmed;
out vec4 base;
void main() {
  vec2 root = field.xy + field.z * blade.xy;
  float bare = worn(root);
  vec4 lush = meadow(root, bare, 0.0);
  // Tussocks stand above the others.
  float tall = field.w * blade.z * (0.5 + 2.2 * lush.w * lush.w) * (1.0 - 0.85 * bare);
  vec3 p = vec3(root, ground);
  float sunny = sunlight(p);
  float own = 6.2831853 * blade.w;
  // Gust fronts are curved.
  float cross_ = dot(root, vec2(-downwind.y, downwind.x)) / field.z;
  float far = dot(root, downwind.xy) - downwind.z + 0.06 * field.z * (sin(7.0 * cross_) + sin(17.0 * cross_ + 2.0));
  float place = (0.5 + 0.5 * clamp(far / downwind.w, -1.0, 1.0)) * float(PLACES - 1);
  int low = min(int(place), PLACES - 2);
  float speed = mix(gusts[low], gusts[low + 1], place - float(low));
  float lean = 1.5 * speed / (speed + 7.0) * (1.0 + 0.12 * sin(9.0 * time + own));
  vec3 back = normalize(eye - p);
  vec2 across = normalize(vec2(-back.y, back.x) + 1e-5) * max(0.02 * field.w, 0.0005 * distance(eye, p));
  p.xy += corner * across;
  if (corner == 0.0) p += tall * vec3(sin(lean) * downwind.xy + 0.25 * vec2(cos(own), sin(own)), cos(lean));
  // The farthest ones pass into the ground beyond them.
  vec3 tint = lush.rgb * (0.8 + 0.5 * blade.w * blade.w) * (1.0 + 0.2 * dot(blade.xy, blade.xy));
  // A bent blade shows its pale side.
  tint *= (corner == 0.0 ? 1.1 : 0.8) + 0.4 * max(0.0, lean - 0.66);
  tint *= dimmed * (0.55 + 0.7 * max(light.z, 0.3)) * mix(vec3(1.0), sun / 0.8, 0.35 * dimmed);
  base = vec4(tint * skyAt(root) * mix(vec3(0.36, 0.4, 0.5), vec3(1.0), sunny), exp(-3.0 * haze * distance(eye, p)));
  gl_Position = seen(p);
}

#part grass.fragment solid.fragment

#part shadow.vertex
precision highp float;
uniform mat4 camera;
uniform vec4 area; // middle x, y, half its size, height
in vec2 corner;
out vec2 at;
void main() {
  at = 0.5 + 0.5 * corner;
  gl_Position = camera * vec4(area.xy + corner * area.z, area.w, 1.0);
}

#part shadow.fragment noise
in vec2 at;
uniform vec4 area;
uniform sampler2D shadow; // 0 in the sun, else the brighter, the lower what casts it
uniform float softness; // widest border of a shadow; 0 where every pixel counts
uniform float depth;
out vec4 color;
void main() {
  float dark = texture(shadow, at).r;
#ifdef PLAIN
  dark = min(1.0, 2.0 * dark);
#else
  // The higher a leaf, the wider the border of its shadow.
  float turn = 6.2831853 * fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.0671, 0.00584))));
  vec2 seen = vec2(0.001, 0.0);
  for (int i = 0; i < 6; i++) {
    float found = texture(shadow, at + softness * vec2(cos(turn + float(i)), sin(turn + float(i)))).r;
    if (found > 0.1) seen += vec2(1.0, 1.0 - found);
  }
  float wide = softness * (0.15 + 1.2 * seen.y / seen.x);
  dark = 0.0;
  for (int i = 0; i < 28; i++) {
    float way = turn + 2.4 * float(i);
    dark += min(1.0, 4.0 * texture(shadow, at + wide * sqrt((float(i) + 0.5) / 28.0) * vec2(cos(way), sin(way))).r);
  }
  vec2 p = 7.0 * (area.xy + area.z * (2.0 * at - 1.0));
  // Spots of sun that has passed between the leaves.
  dark *= (1.0 - 0.45 * smoothstep(0.55, 0.8, 0.6 * noise(0.3 * p) + 0.4 * noise(p))) / 28.0;
#endif
  vec2 rim = min(at, 1.0 - at);
  float sky = skyAt(area.xy + area.z * (2.0 * at - 1.0));
  float open = (1.0 - depth * dark) * mix(1.0, sky, smoothstep(0.0, 0.15, min(rim.x, rim.y)));
  if (open > 0.99) discard;
  color = vec4(0.06, 0.08, 0.11, 1.0 - open);
}

#part backdrop.vertex
precision highp float;
layout(location = 0) in vec2 corner;
uniform vec3 right;
uniform vec3 up;
uniform vec3 back;
out vec3 ray;
void main() {
  ray = corner.x * right + corner.y * up - back;
  gl_Position = vec4(corner, 0.99999, 1.0);
}

#part backdrop.fragment noise
in vec3 ray;
uniform vec3 eye;
uniform float ground;
uniform float haze;
uniform float kind;
uniform vec3 light;
uniform vec3 sun;
uniform vec3 sky;
uniform vec3 zenith;
uniform vec3 horizon;
uniform float dimmed;
out vec4 color;
// Sum of noises, each half as large and half as strong as the one before, 0 to 1.
float cloudy(vec2 p) {
  float sum = 0.0;
  for (float part = 0.5; part > 0.012; part *= 0.5) {
    sum += part * noise(p);
    p = mat2(1.6, 1.2, -1.2, 1.6) * p + 3.7;
  }
  return sum;
}
// Round lobes that lie over each other: from the middle of the uppermost, and its height, 0 to 1.
vec3 lobes(vec2 p) {
  vec3 best = vec3(0.0);
  for (float i = -1.0; i < 2.0; i++) {
    for (float j = -1.0; j < 2.0; j++) {
      vec2 cell = floor(p) + vec2(i, j);
      vec2 from = p - cell - vec2(hash(cell), hash(cell + 57.0));
      float high = 1.0 - dot(from, from) / (0.4 + 0.9 * hash(cell + 31.0));
      if (high > best.z) best = vec3(from, high);
    }
  }
  return best;
}
// Brightness of discs out of focus, each of its own, which lie over each other.
float discs(vec2 p) {
  float sum = 0.0;
  for (float i = -1.0; i < 2.0; i++) {
    for (float j = -1.0; j < 2.0; j++) {
      vec2 cell = floor(p) + vec2(i, j);
      float far = distance(p, cell + vec2(hash(cell), hash(cell + 57.0)));
      float bright = hash(cell + 31.0);
      sum += bright * bright * bright * (0.7 + 0.6 * far) * (1.0 - smoothstep(0.55, 0.68, far));
    }
  }
  return sum;
}
vec3 heaven(vec3 way) {
  float high = max(way.z, 0.0);
  vec3 c = mix(horizon, zenith, 1.0 - exp(-3.6 * high));
  // Clouds, torn at their edges, whose sides towards the sun are brighter; the farther, the flatter.
  vec2 at = 1.25 * way.xy / (high + 0.16);
  at += 0.3 * vec2(noise(1.7 * at), noise(1.7 * at + 9.0));
  float cloud = cloudy(at);
  float thick = smoothstep(0.46, 0.66, cloud) * smoothstep(0.0, 0.2, high);
  float shaded = clamp(4.0 * (cloudy(at + 0.16 * light.xy) - cloud) + 0.5 * thick, 0.0, 1.0);
  c = mix(c, mix(horizon * 1.12, mix(horizon, zenith, 0.5), shaded), 0.9 * thick);
  float glow = max(dot(way, light), 0.0);
  c += sun * (0.1 * pow(glow, 6.0) + 0.16 * pow(glow, 60.0)) * dimmed;
  // Hills, the nearer ones darker.
  float turn = 3.0 * atan(way.y, way.x);
  float far = 0.03 + 0.03 * noise(vec2(turn * 1.3 + 40.0, 3.0)) + 0.006 * noise(vec2(turn * 9.0, 1.0));
  float near = 0.012 + 0.03 * noise(vec2(turn * 2.1 + 9.0, 8.0)) + 0.003 * noise(vec2(turn * 40.0, 5.0));
  vec3 blue = mix(zenith, vec3(0.3, 0.4, 0.34) * dimmed, 0.6);
  if (way.z < far) c = mix(horizon, blue, 0.14 + 0.16 * way.z / far);
  if (way.z < near) c = mix(horizon, blue, 0.3 + 0.25 * way.z / near);
  // Edges of woods, the nearer ones higher: crowns lit from above, with shade between them.
  for (float row = 0.0; row < 2.0; row++) {
    vec2 along = vec2(turn * (46.0 - 14.0 * row) + 31.0 * row, row);
    float wood = (1.0 + 0.9 * row) * (0.002 + 0.012 * noise(along * vec2(0.09, 1.0))
      + 0.006 * noise(along) * noise(along * 0.5) + 0.0035 * noise(along * vec2(3.1, 1.0)) + 0.0016 * noise(along * vec2(9.0, 1.0)));
    wood -= 0.016 * row * smoothstep(0.3, 0.7, noise(along * vec2(0.13, 1.0) + 5.0));
    if (way.z > wood) continue;
    vec2 leaf = vec2(along.x, 900.0 * way.z);
    float lit = 0.45 * noise(leaf * vec2(1.6, 0.2)) + 0.35 * noise(leaf * vec2(5.0, 0.6)) + 0.25 * noise(leaf * vec2(14.0, 1.6));
    lit *= 0.35 + 0.65 * smoothstep(0.0, 1.0, way.z / wood);
    vec3 leafy = dimmed * mix(vec3(0.15, 0.21, 0.14), mix(vec3(0.46, 0.52, 0.26), vec3(0.3, 0.42, 0.25), noise(along)), lit);
    c = mix(leafy, horizon, 0.4 - 0.2 * row);
  }
  return c;
}
#ifndef PLAIN
// Where a ray meets the cylinder on which a row of trees stands around the scene: along it, and above the ground [m].
vec2 onRow(vec3 way, float round) {
  float a = dot(way.xy, way.xy);
  float b = dot(eye.xy, way.xy);
  float inside = round * round - dot(eye.xy, eye.xy);
  if (inside < 0.0 || a < 1e-4) return vec2(-99.0);
  vec3 p = eye + (sqrt(b * b + a * inside) - b) / a * way;
  return vec2((atan(p.y, p.x) / 6.2831853 + 0.5) * floor(round * 0.7) * 9.0, p.z - ground);
}
// Trees behind a plant on a terrace, out of focus: masses of every size, light above and dark below, and discs of light
// between the leaves. Colour, and how much of it is seen.
vec4 blurred(vec3 way, float round, float seed) {
  vec2 at = onRow(way, round);
  float up = at.y;
  if (up < -3.0 || up > 30.0) return vec4(0.0);
  float x = at.x + 70.0 * seed;
  float soft = 0.012 * round;
  float high = 1.5 + 0.05 * round * noise(vec2(x / 31.0, seed)) + 11.0 * pow(noise(vec2(x / 11.0, seed + 2.0)), 1.5)
    + 4.5 * noise(vec2(x / 4.7, seed + 4.0)) + 1.8 * noise(vec2(x / 2.1, seed + 6.0));
  vec2 leaf = mat2(0.8, 0.6, -0.6, 0.8) * vec2(x, up);
  float mass = 0.5 * noise(leaf / vec2(6.0, 4.4)) + 0.3 * noise(leaf / 2.7 + 7.0) + 0.2 * noise(leaf / 1.3 + 5.0);
  float over = up - high + 5.0 * (mass - 0.5);
  float shown = (1.0 - smoothstep(-soft, soft, over)) * smoothstep(-0.5 * soft, 0.6 * soft, up);
  // Each tree has a green of its own.
  vec3 own = mix(vec3(0.16, 0.23, 0.12), vec3(0.36, 0.38, 0.17), noise(vec2(x / 8.0, seed + 9.0)));
  own = mix(own, vec3(0.2, 0.25, 0.2), 0.7 * smoothstep(0.5, 0.8, noise(vec2(x / 13.0, seed + 15.0))));
  float lit = mix(0.25, 1.0, smoothstep(0.25, 0.75, mass)) * (0.45 + 0.55 * smoothstep(0.0, 1.0, up / high));
  vec3 c = own * toned(vec3(0.5) * (0.35 + 0.7 * lit) + 1.5 * sun * lit * smoothstep(-0.5, 1.0, light.z + 0.6 * (mass - 0.5)));
  // Stems, and light between them.
  float low = 1.0 - smoothstep(0.15, 0.45, up / high);
  c = mix(c, vec3(0.13, 0.12, 0.1), 0.3 * low * smoothstep(0.55, 0.8, noise(vec2(x / 1.4, seed + 20.0))));
  float light_ = discs(leaf / soft / 1.1) + 0.7 * discs(leaf / soft / 0.6 + 40.0);
  c += light_ * (0.3 * own * sun * lit + 0.13 * horizon * smoothstep(-4.0, 1.0, over) * smoothstep(0.2, 0.6, up / high));
  return vec4(c, shown);
}
// A row of trees around the scene, over what is behind them: colour, and how much of it is seen.
vec4 treeRow(vec3 way, float round, float seed) {
  vec2 leaf = onRow(way, round);
  float up = leaf.y;
  if (up < -0.5 || up > 22.0) return vec4(0.0);
  float cells = floor(round * 0.7);
  float along = leaf.x / 9.0;
  float turn = 6.2831853 * (along / cells - 0.5);
  vec2 outward = vec2(cos(turn), sin(turn));
  vec2 beside = vec2(-outward.y, outward.x);
  // Boughs are round, with shade between them.
  const float rim = 0.3;
  float fine = 2.0 * cloudy(1.9 * leaf + seed) - 0.5;
  vec3 bough = lobes(leaf / 2.4 + 0.5 * fine + seed);
  float rough = 0.15 * bough.z + 0.85 * fine;
  // Woods, hedges and gaps.
  float wooded = smoothstep(0.16, 0.42, tiled(vec2(along * 0.11, seed), vec2(floor(cells * 0.11), 65536.0)));
  vec4 best = vec4(0.0);
  for (float k = -1.0; k < 2.0; k++) {
    float cell = mod(floor(along) + k, cells);
    vec2 name = vec2(cell, 17.0 * seed);
    float one = hash(name);
    float two = hash(name + 71.0);
    float dense = smoothstep(0.16, 0.42, tiled(vec2(cell * 0.11, seed), vec2(floor(cells * 0.11), 65536.0)));
    if (one < 0.8 - 0.8 * dense) continue;
    float high = hash(name + 5.0);
    float tall = (7.0 + 10.0 * high * high) * (0.5 + 0.5 * dense);
    float wide = tall * mix(0.34, 0.55, two) + 1.0;
    bool isPointed = hash(name + 9.0) < 0.2 * dense;
    if (isPointed) { wide *= 0.6; tall *= 1.1; }
    float x = (along - floor(along) - k - 0.5 - 0.5 * (one - 0.5)) * 9.0 / wide;
    float z = (up - 0.52 * tall) / (0.5 * tall);
    float swell = isPointed ? 0.55 - 0.5 * z : 1.0;
    float edge = length(vec2(x / max(swell, 0.05), z * (z < 0.0 ? 0.92 : 1.0))) - (isPointed ? 0.7 : 0.9) * (rough - 0.45);
    float shown = max(1.0 - smoothstep(1.0 - rim, 1.0 + rim, edge), z < 0.0 && abs(x) * wide < 0.03 * tall ? 1.0 : 0.0);
    float deep = sqrt(max(0.0, 1.0 - min(1.0, x * x + z * z)));
    vec3 n = normalize(vec3((x + 0.3 * bough.x) * beside - deep * outward, z + 0.3 * bough.y));
    float shone = max(0.0, 0.2 + 0.8 * dot(n, light)) * smoothstep(0.1, 0.7, rough);
    vec3 own = mix(isPointed ? vec3(0.13, 0.2, 0.11) : vec3(0.2, 0.27, 0.12), vec3(0.27, 0.31, 0.15), one * one * (isPointed ? 0.2 : 1.0));
    vec3 lit = own * toned(sky * (0.3 + 0.25 * z + 0.5 * rough) + 1.2 * sun * shone);
    if (edge > 1.0 + rim) lit = vec3(0.12, 0.1, 0.08);
    // The right one stands before the left one.
    best = vec4(mix(best.rgb, lit, shown / max(shown + best.a * (1.0 - shown), 1e-3)), shown + best.a * (1.0 - shown));
  }
  // Bushes and nettles hide the stems.
  float bush = 0.5 * (wooded * (1.4 + 2.6 * noise(leaf * 0.3)) - 0.6 + 1.6 * (rough - 0.5) - up);
  vec3 leafy = mix(vec3(0.1, 0.14, 0.07), vec3(0.3, 0.36, 0.16), clamp(0.25 * up + 1.0 * (rough - 0.4), 0.0, 1.0));
  float shown = smoothstep(0.0, 4.0 * rim, bush) * smoothstep(-0.02, 0.0, up);
  best = vec4(mix(best.rgb, leafy, shown / max(shown + best.a * (1.0 - shown), 1e-3)), shown + best.a * (1.0 - shown));
  return best;
}
#endif
// Brightness of blades that stand in rows, at a place from below the eye over its height.
float blades(vec2 p, float size) {
  float turn = atan(p.y, p.x) / size / size;
  float at = inversesqrt(length(p) + 1e-6) / size; // in rows
  float sum = 0.0;
  for (float row = ceil(at); row < at + 4.0; row++) {
    vec2 q = vec2(turn / row, row);
    float high = 0.25 * (row - at);
    float tuft = noise(0.4 * q);
    q.x += 8.0 * high * high * (tuft - 0.5);
    float own = hash(floor(q));
    high -= 0.25 * own;
    float edge = 0.5 - 0.5 * high / (0.2 + 0.4 * tuft + 0.4 * fract(9.0 * own)) - abs(fract(q.x) - 0.5);
    sum = mix(sum, high + 0.6 * fract(33.0 * own), smoothstep(-0.1, 0.1, edge));
  }
  return sum - 0.5;
}
void main() {
  vec3 way = normalize(ray);
  vec3 c = heaven(way);
  if (way.z < -1e-4) {
    float far = (ground - eye.z) / way.z;
    vec2 p = eye.xy + far * way.xy;
    float pixel = far * length(fwidth(ray)) / max(-way.z, 0.05) * 0.5;
    vec3 soil;
    if (kind < 0.5 && max(abs(p.x - stem.x), abs(p.y - stem.y)) < 0.009 / haze) {
      // A terrace.
      vec2 slab = p / 0.6;
      slab.x += 0.5 * mod(floor(slab.y), 2.0);
      vec2 edge = abs(fract(slab) - 0.5);
      float joint = smoothstep(0.485, 0.495, max(edge.x, edge.y)) * (1.0 - smoothstep(0.1, 0.5, pixel / 0.12));
      soil = vec3(0.52, 0.505, 0.475) * (1.0 + 0.09 * (hash(floor(slab)) - 0.5));
      soil *= 1.0 + 0.07 * grain(p, 0.35, pixel) + 0.1 * grain(p, 0.08, pixel) + 0.12 * grain(p, 0.03, pixel) + 0.16 * grain(p, 0.006, pixel);
      soil *= 1.0 - 0.26 * joint;
    } else {
      float bare = worn(p);
      soil = meadow(p, bare, pixel).rgb;
      float size = 4.5 * pow(eye.z - ground, -0.2) * length(fwidth(ray));
      float grassy = 1.0 - 0.8 * bare;
      if (kind < 0.5) {
        // Out of focus.
        grassy *= 0.2;
        soil = mix(soil, vec3(0.37, 0.43, 0.22), 0.75);
      }
      soil *= 1.0 + 0.42 * grassy * blades(way.xy / way.z, size) / (1.0 - 0.03 / way.z) + 0.3 * grassy * grain(p, 0.05, pixel);
      // Daisies, where there is less grass.
      vec2 cell = p / 0.17;
      vec2 to = fract(cell) - 0.5 - 0.6 * (vec2(hash(floor(cell) + 3.0), hash(floor(cell) + 7.0)) - 0.5);
      // They stand upright.
      to -= 0.65 * dot(to, normalize(way.xy)) * normalize(way.xy);
      float seed = hash(floor(cell)) / max(0.02, 0.16 * smoothstep(0.5, 0.8, noise(p / 2.3 + 70.0)));
      float petals = max(0.13, 0.5 * pixel / 0.17);
      if (seed < 1.0 && kind > 0.5) soil = mix(soil, vec3(0.93, 0.93, 0.88), min(1.0, 0.02 / petals / petals) * (1.0 - smoothstep(0.7 * petals, petals, length(to))));
    }
    soil *= dimmed * (0.55 + 0.7 * max(light.z, 0.3)) * mix(vec3(1.0), sun / 0.8, 0.35 * dimmed);
    // Far meadows stay green up to the edge of the wood.
    c = mix(horizon, soil, max(0.6, exp(-3.0 * haze * far)));
  }
#ifndef PLAIN
  // Rows of trees stand on it, the far one first.
  for (float row = 3.0; row > 0.0; row--) {
    float round = (0.07 + 0.1 * row) / haze;
    vec4 trees = kind < 0.5 ? blurred(way, 0.5 * round, 11.0 * row) : treeRow(way, round, 11.0 * row);
    c = mix(c, mix(dimmed * trees.rgb, horizon, (kind < 0.5 ? 0.0 : 0.24) + 0.12 * row), trees.a);
  }
#endif
  color = vec4(c, 1.0);
}

#part copy.vertex
layout(location = 0) in vec2 corner;
void main() { gl_Position = vec4(corner, 0.99999, 1.0); }

#part copy.fragment
precision mediump float;
uniform sampler2D picture;
out vec4 color;
void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
