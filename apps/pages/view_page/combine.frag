// Second pass: colours are fetched backward from both photographs at the warped disparities, and
// the two are blended. Positions that neither image reaches are left as holes, of alpha 0.

uniform sampler2D uLeftImage;
uniform sampler2D uRightImage;
uniform sampler2D uLeftMap;
uniform sampler2D uRightMap;
uniform highp usampler2D uLeftWarped;
uniform highp usampler2D uRightWarped;
uniform vec2 uLeftShift;
uniform vec2 uRightShift;
uniform int uMargin;
uniform float uAlpha;  // weight of the left image where both show one surface
// What a pixel beside which its surface ends counts, beside one of the other image whose surface
// goes on: it is often a mixture of two surfaces.
uniform float uTrustAtEnds;
// Brightness of each image in the new view: scale * colour + offset.
uniform vec3 uLeftScale;
uniform vec3 uLeftOffset;
uniform vec3 uRightScale;
uniform vec3 uRightOffset;

layout(location = 0) out vec4 oColour;
layout(location = 1) out uint oDisparity;

// Which of four taps in a line take part: those of another surface count with their neighbour's
// value, so that colours do not mix across a depth discontinuity. `first` is the tap before the
// position, `length` the number of pixels of the line.
ivec4 tapsOnSurface(int first, float f, bvec4 on, int length) {
  ivec4 tap = first + ivec4(-1, 0, 1, 2);
  if (!on[1] && !on[2]) {
    return ivec4(clamp(f < 0.5 ? tap[1] : tap[2], 0, length - 1));
  }
  if (!on[1]) {
    tap[1] = tap[2];
  } else if (!on[2]) {
    tap[2] = tap[1];
  }
  tap[0] = on[0] && on[1] ? tap[0] : tap[1];
  tap[3] = on[3] && on[2] ? tap[3] : tap[2];
  return tap;
}

// Keys' cubic, a = -1/2.
vec4 cubicWeights(float f) {
  return vec4(f * (f * (1.0 - 0.5 * f) - 0.5),
              f * f * (1.5 * f - 2.5) + 1.0,
              f * (f * (2.0 - 1.5 * f) + 0.5),
              f * f * (0.5 * f - 0.5));
}

// Splits position + shift into the pixel before it and the rest. Never sums the two: a large
// coordinate would swallow the last digits of the rest.
void split(int position, float shift, int length, out int whole, out float f) {
  whole = position + int(floor(shift));
  f = shift - floor(shift);
  if (whole < -1) {
    whole = -1;
    f = 0.0;
  } else if (whole > length - 1 || (whole == length - 1 && f > 0.5)) {
    whole = length - 1;
    f = 0.5;
  }
}

vec3 fetchRow(sampler2D image, sampler2D map, int x, float f, int y, float d) {
  bvec4 on;
  for (int k = 0; k < 4; ++k) {
    on[k] = isOneSurface(disparityAt(map, ivec2(x - 1 + k, y)), d);
  }
  ivec4 tap = tapsOnSurface(x, f, on, uSize.x);
  vec4 weight = cubicWeights(f);
  return weight[0] * texelFetch(image, ivec2(tap[0], y), 0).rgb
       + weight[1] * texelFetch(image, ivec2(tap[1], y), 0).rgb
       + weight[2] * texelFetch(image, ivec2(tap[2], y), 0).rgb
       + weight[3] * texelFetch(image, ivec2(tap[3], y), 0).rgb;
}

// The colour of the surface of disparity d that the new view shows at `position`.
vec3 fetch(sampler2D image, sampler2D map, ivec2 position, vec2 shift, float d) {
  if (shift == vec2(0.0)) {
    return texelFetch(image, position, 0).rgb;  // the camera's own place
  }
  int x;
  float fx;
  split(position.x, shift.x * d, uSize.x, x, fx);
  if (shift.y == 0.0) {
    return clamp(fetchRow(image, map, x, fx, position.y, d), 0.0, 1.0);
  }
  int y;
  float fy;
  split(position.y, shift.y * d, uSize.y, y, fy);
  bvec4 on;
  for (int k = 0; k < 4; ++k) {
    int row = y - 1 + k;
    on[k] = isOneSurface(disparityAt(map, ivec2(x, row)), d)
         || isOneSurface(disparityAt(map, ivec2(x + 1, row)), d);
  }
  ivec4 row = tapsOnSurface(y, fy, on, uSize.y);
  vec4 weight = cubicWeights(fy);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    sum += weight[k] * fetchRow(image, map, x, fx, row[k], d);
  }
  return clamp(sum, 0.0, 1.0);
}

float warpedDisparity(highp usampler2D warped, ivec2 position) {
  return uintBitsToFloat(texelFetch(warped, position + uMargin, 0).r);
}

// Whether the surface that a warped image has at a position goes on to both sides; borders count
// as going on.
bool goesOn(highp usampler2D warped, ivec2 position) {
  float d = warpedDisparity(warped, position);
  float before = warpedDisparity(warped, ivec2(max(position.x - 1, 0), position.y));
  float behind = warpedDisparity(warped, ivec2(min(position.x + 1, uSize.x - 1), position.y));
  return isOneSurface(before, d) && isOneSurface(behind, d);
}

float leftWeight(ivec2 position, float left, float right) {
  if (left == UNKNOWN || right == UNKNOWN) {
    return right == UNKNOWN ? 1.0 : 0.0;
  }
  // The view is a camera's own: that camera alone decides.
  if (uAlpha >= 1.0 || uAlpha <= 0.0) {
    return uAlpha >= 1.0 ? 1.0 : 0.0;
  }
  if (isOneSurface(left, right)) {
    float ofLeft = uAlpha * (goesOn(uLeftWarped, position) ? 1.0 : uTrustAtEnds);
    float ofRight = (1.0 - uAlpha) * (goesOn(uRightWarped, position) ? 1.0 : uTrustAtEnds);
    return ofLeft / (ofLeft + ofRight);
  }
  return left > right ? 1.0 : 0.0;
}

void main() {
  ivec2 position = ivec2(gl_FragCoord.xy);
  float left = warpedDisparity(uLeftWarped, position);
  float right = warpedDisparity(uRightWarped, position);
  if (left == UNKNOWN && right == UNKNOWN) {
    oColour = vec4(0.0);
    oDisparity = floatBitsToUint(UNKNOWN);
    return;
  }
  float share = leftWeight(position, left, right);
  vec3 colour = vec3(0.0);
  float d = 0.0;
  if (share > 0.0) {
    colour += share * (uLeftScale * fetch(uLeftImage, uLeftMap, position, uLeftShift, left)
                       + uLeftOffset);
    d += share * left;
  }
  if (share < 1.0) {
    colour += (1.0 - share) * (uRightScale * fetch(uRightImage, uRightMap, position, uRightShift,
                                                   right) + uRightOffset);
    d += (1.0 - share) * right;
  }
  oColour = vec4(clamp(colour, 0.0, 1.0), 1.0);
  oDisparity = floatBitsToUint(d);
}
