// Fourth pass on the baseline: outlines like a photograph's. A warp moves surfaces by whole pixels
// and never mixes them; here the two positions at an outline take a share of each other. The
// outline's exact place is known, and the shares follow it, so that it moves without jumps.

uniform sampler2D uColour;
uniform highp usampler2D uDisparity;  // of the view, holes filled
uniform highp usampler2D uLeftWarped;
uniform highp usampler2D uRightWarped;
uniform vec2 uLeftShift;
uniform vec2 uRightShift;
uniform int uMargin;
uniform float uAlpha;

layout(location = 0) out vec4 oColour;
layout(location = 1) out uint oDisparity;

const float USUAL_SHARE = 0.2;
const float MOST_SHARE = 0.5;
// Surfaces that a view moves apart by less still have some of the photograph's own outline.
const float SYNTHETIC_SHIFT_PX = 2.0;

float viewDisparity(ivec2 position) {
  return position.x < 0 || position.x >= uSize.x
      ? UNKNOWN
      : uintBitsToFloat(texelFetch(uDisparity, position, 0).r);
}

// How much the left (x) and right (y) image count for what the view shows.
vec2 imageShares(float d, float left, float right) {
  bool inLeft = isOneSurface(left, d);
  bool inRight = isOneSurface(right, d);
  return inLeft != inRight ? vec2(inLeft, inRight) : vec2(uAlpha, 1.0 - uAlpha);
}

// How far to the right of its position a pixel of one image was mapped.
float mappedBeside(float shift, float d) {
  float exact = shift * d;
  return d == UNKNOWN ? 0.0 : floor(exact + 0.5) - exact;
}

vec2 warped(ivec2 position) {
  return vec2(uintBitsToFloat(texelFetch(uLeftWarped, position + uMargin, 0).r),
              uintBitsToFloat(texelFetch(uRightWarped, position + uMargin, 0).r));
}

// The share that this position takes of the one beside it (direction 1 or -1), in 256ths.
float shareOfNeighbour(ivec2 position, int direction) {
  ivec2 beside = position + ivec2(direction, 0);
  float own = viewDisparity(position);
  float other = viewDisparity(beside);
  if (own == UNKNOWN || other == UNKNOWN || isOneSurface(own, other)) {
    return 0.0;
  }
  bool isNearer = own > other;
  vec2 here = warped(position);
  vec2 there = warped(beside);
  vec2 fromNearer = isNearer ? here : there;
  vec2 fromFarther = isNearer ? there : here;
  vec2 nearer = imageShares(max(own, other), fromNearer.x, fromNearer.y);
  vec2 farther = imageShares(min(own, other), fromFarther.x, fromFarther.y);
  vec2 mapped = vec2(mappedBeside(uLeftShift.x, fromNearer.x),
                     mappedBeside(uRightShift.x, fromNearer.y));
  // Of the farther position; negative: free of the nearer one.
  float covered = dot(nearer, mapped) * float(isNearer ? direction : -direction);
  float shiftPx = dot(farther, abs(vec2(uLeftShift.x, uRightShift.x))) * abs(own - other);
  float strength = min(1.0, shiftPx / SYNTHETIC_SHIFT_PX);
  float part = isNearer ? -covered : covered;
  float slope = part > 0.0 ? MOST_SHARE - USUAL_SHARE : USUAL_SHARE;  // per half a pixel
  return floor(strength * (USUAL_SHARE + 2.0 * slope * part) * 256.0 + 0.5);
}

void main() {
  ivec2 position = ivec2(gl_FragCoord.xy);
  float ofLeft = shareOfNeighbour(position, -1) / 256.0;
  float ofRight = shareOfNeighbour(position, 1) / 256.0;
  vec4 colour = texelFetch(uColour, position, 0);
  vec4 left = texelFetch(uColour, ivec2(max(position.x - 1, 0), position.y), 0);
  vec4 right = texelFetch(uColour, ivec2(min(position.x + 1, uSize.x - 1), position.y), 0);
  oColour = colour + ofLeft * (left - colour) + ofRight * (right - colour);
  oDisparity = texelFetch(uDisparity, position, 0).r;
}
