// After the third pass: what was filled becomes a mean of the background around it, weighted with
// the inverse square of the distance. Samples are the next pixels that were not filled, in the
// pixel's own row and in some above and below.

uniform sampler2D uColour;            // alpha 0: filled
uniform highp usampler2D uDisparity;  // holes filled

layout(location = 0) out vec4 oColour;
layout(location = 1) out uint oDisparity;

const int REACH_ROWS = 16;
const int BESIDE_PX = 64;  // as far from the hole samples are looked for in other rows
const int ROWS_PER_LENGTH = 4;
const int ROWS[11] = int[11](0, -1, 1, -2, 2, -4, 4, -8, 8, -16, 16);

bool isFilled(ivec2 position) {
  return texelFetch(uColour, position, 0).a == 0.0;
}

float disparityAtView(ivec2 position) {
  return uintBitsToFloat(texelFetch(uDisparity, position, 0).r);
}

// From `position` on in a direction (1 or -1), the column of the first pixel that was not filled;
// `end` if there is none before it.
int nextColumn(ivec2 position, int direction, int end) {
  while (position.x != end && isFilled(position)) {
    position.x += direction;
  }
  return position.x;
}

// Disparity of the next pixel in the column that was not filled.
float alongColumn(ivec2 position, int direction) {
  for (int k = 1; k <= REACH_ROWS; ++k) {
    position.y += direction;
    if (position.y < 0 || position.y >= uSize.y) {
      break;
    }
    if (!isFilled(position)) {
      return disparityAtView(position);
    }
  }
  return UNKNOWN;
}

float alongColumns(ivec2 position) {
  return min(alongColumn(position, -1), alongColumn(position, 1));
}

vec4 sampleAt(ivec2 position, ivec2 from, float background) {
  if (disparityAtView(from) - background > uGradientLimit) {
    return vec4(0.0);
  }
  vec2 apart = vec2(from - position);
  float represented = abs(apart.y) <= 1.0 ? 1.0 : 0.75 * abs(apart.y);
  float weight = represented / dot(apart, apart);
  return weight * vec4(texelFetch(uColour, from, 0).rgb, 1.0);
}

vec4 samplesOfRow(ivec2 position, int row, int begin, int end, float background) {
  ivec2 here = ivec2(position.x, row);
  if (!isFilled(here)) {
    return sampleAt(position, here, background);
  }
  int first = max(begin - BESIDE_PX, 0);
  int limit = min(end + BESIDE_PX, uSize.x);
  int before = nextColumn(here, -1, first - 1);
  int after = nextColumn(here, 1, limit);
  vec4 sum = vec4(0.0);
  if (before >= first) {
    sum += sampleAt(position, ivec2(before, row), background);
  }
  if (after < limit) {
    sum += sampleAt(position, ivec2(after, row), background);
  }
  return sum;
}

void main() {
  ivec2 position = ivec2(gl_FragCoord.xy);
  oColour = texelFetch(uColour, position, 0);
  oDisparity = texelFetch(uDisparity, position, 0).r;
  if (oColour.a != 0.0) {
    return;
  }
  oColour.a = 1.0;
  int begin = nextColumn(position, -1, -1) + 1;
  int end = nextColumn(position, 1, uSize.x);
  if (begin == 0 && end == uSize.x) {
    return;
  }
  float background = alongColumns(position);
  background = max(background, alongColumns(ivec2(max(position.x - 1, begin), position.y)));
  background = max(background, alongColumns(ivec2(min(position.x + 1, end - 1), position.y)));
  if (begin > 0) {
    background = min(background, disparityAtView(ivec2(begin - 1, position.y)));
  }
  if (end < uSize.x) {
    background = min(background, disparityAtView(ivec2(end, position.y)));
  }
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 11; ++k) {
    int row = position.y + ROWS[k];
    if (abs(ROWS[k]) <= ROWS_PER_LENGTH * (end - begin) && row >= 0 && row < uSize.y) {
      sum += samplesOfRow(position, row, begin, end, background);
    }
  }
  if (sum.a > 0.0) {
    oColour.rgb = sum.rgb / sum.a;
  }
}
