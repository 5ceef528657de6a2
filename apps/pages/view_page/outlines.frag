// Fourth pass off the baseline: surfaces mix where they meet, in the shares in which they cover a
// pixel of the view, as the outlines in both maps tell. What its own surface leaves free shows the
// farther ones of the pixel's four neighbours; then the nearer ones cover what is theirs.

uniform sampler2D uColour;
uniform highp usampler2D uDisparity;  // of the view, holes filled
uniform sampler2D uLeftMap;
uniform sampler2D uRightMap;
uniform highp usampler2D uLeftWarped;
uniform highp usampler2D uRightWarped;
uniform vec2 uLeftShift;
uniform vec2 uRightShift;
uniform int uMargin;
uniform float uAlpha;

layout(location = 0) out vec4 oColour;
layout(location = 1) out uint oDisparity;

// A coverage that is not known.
const float NOT_KNOWN = -1.0;
// A surface and its background that come from places so far apart have nothing left of the
// photograph's own transition between them.
const float SYNTHETIC_SHIFT_PX = 2.0;
// Neither image is believed to be more certain: outlines of round objects differ.
const float MOST_CERTAIN = 0.98;

const ivec2 SIDES[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

float viewDisparity(ivec2 position) {
  return any(lessThan(position, ivec2(0))) || any(greaterThanEqual(position, uSize))
      ? UNKNOWN
      : uintBitsToFloat(texelFetch(uDisparity, position, 0).r);
}

// Weights of the pixels at -1, 0 and 1 for a place at `offset` = -1/2..1/2: bilinear, or the
// quadratic B-spline, or between the two.
vec3 pixelWeights(float offset, float splineShare) {
  float before = 0.5 - offset;
  float behind = 0.5 + offset;
  vec3 spline = vec3(0.5 * before * before, 0.75 - offset * offset, 0.5 * behind * behind);
  vec3 linear = vec3(max(-offset, 0.0), 1.0 - abs(offset), max(offset, 0.0));
  return mix(linear, spline, splineShare);
}

// How much of the pixel at `position` is covered by the surface that the view shows at `from` with
// disparity d, as one image knows it. An image tells its outlines to half a pixel; the spline is
// the mean over what is possible.
float imageCoverage(sampler2D map, highp usampler2D warped, vec2 shift, ivec2 position, ivec2 from,
                    float d, float background) {
  float own = uintBitsToFloat(texelFetch(warped, from + uMargin, 0).r);
  if (!isOneSurface(own, d)) {
    return NOT_KNOWN;
  }
  float splineShare = min(1.0, length(shift) * abs(background - own) / SYNTHETIC_SHIFT_PX);
  // Never position + shift: a large coordinate would swallow the last digits of the offset.
  vec2 moved = shift * own;
  vec2 whole = floor(moved + 0.5);
  vec3 weightX = pixelWeights(moved.x - whole.x, splineShare);
  vec3 weightY = pixelWeights(moved.y - whole.y, splineShare);
  ivec2 centre = position + ivec2(whole);
  float covered = 0.0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      ivec2 pixel = clamp(centre + ivec2(i - 1, j - 1), ivec2(0), uSize - 1);
      covered += isOneSurface(disparityAt(map, pixel), own) ? weightX[i] * weightY[j] : 0.0;
    }
  }
  return min(covered, 1.0);
}

// As both know it: where they count alike, two independent observations, of which odds are
// multiplied; the more one prevails by weight, the more it is their mean.
float coverage(ivec2 position, ivec2 from, float d, float background) {
  float left = imageCoverage(uLeftMap, uLeftWarped, uLeftShift, position, from, d, background);
  float right = imageCoverage(uRightMap, uRightWarped, uRightShift, position, from, d, background);
  if (left == NOT_KNOWN || right == NOT_KNOWN) {
    return max(left, right);
  }
  float average = mix(right, left, uAlpha);
  float a = clamp(left, 1.0 - MOST_CERTAIN, MOST_CERTAIN);
  float b = clamp(right, 1.0 - MOST_CERTAIN, MOST_CERTAIN);
  float together = a * b / (a * b + (1.0 - a) * (1.0 - b));
  return mix(average, together, 4.0 * uAlpha * (1.0 - uAlpha));
}

void main() {
  ivec2 position = ivec2(gl_FragCoord.xy);
  float own = viewDisparity(position);
  // Pixels whose surfaces end here: those of nearer neighbours, and its own before farther ones.
  ivec2 ending[5];
  int count = 0;
  vec4 farther = vec4(0.0);
  float fartherCount = 0.0;
  float farthest = own;
  for (int k = 0; k < 4; ++k) {
    ivec2 beside = position + SIDES[k];
    float d = viewDisparity(beside);
    if (own == UNKNOWN || d == UNKNOWN || isOneSurface(own, d)) {
      continue;
    }
    if (d < own) {
      farther += texelFetch(uColour, beside, 0);
      fartherCount += 1.0;
      farthest = min(farthest, d);
    } else {
      ending[count++] = beside;
    }
  }
  if (fartherCount > 0.0) {
    ending[count++] = position;
  }

  float ownCovers = 1.0;
  vec4 nearer = vec4(0.0);
  float nearerSum = 0.0;
  float mostCovered = 0.0;
  for (int k = 0; k < count; ++k) {
    bool isOwn = ending[k] == position;
    float covered = coverage(position, ending[k], viewDisparity(ending[k]),
                             isOwn ? farthest : own);
    if (covered == NOT_KNOWN) {
      continue;
    }
    if (isOwn) {
      ownCovers = covered;
    } else {
      nearer += covered * texelFetch(uColour, ending[k], 0);
      nearerSum += covered;
      mostCovered = max(mostCovered, covered);
    }
  }
  vec4 colour = texelFetch(uColour, position, 0);
  if (fartherCount > 0.0) {
    colour = mix(farther / fartherCount, colour, ownCovers);
  }
  if (nearerSum > 0.0) {
    colour = mix(colour, nearer / nearerSum, mostCovered);
  }
  oColour = colour;
  oDisparity = texelFetch(uDisparity, position, 0).r;
}
