// What the shaders share: how a disparity map is read.

// A map comes as an RGB picture, because that is all a page can hold without losing bits: red and
// green are the two bytes of a number n; n = 0 is unknown, else the disparity is
// uSmallest + (n - 1) * uStep.
uniform float uSmallest;
uniform float uStep;
uniform ivec2 uSize;           // of the images and maps
uniform float uGradientLimit;  // neighbours that differ by at most this are one surface

// Far from any disparity, so that no comparison takes it for the neighbour of one.
const float UNKNOWN = 1.0e30;

float disparityAt(sampler2D map, ivec2 pixel) {
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, uSize))) {
    return UNKNOWN;
  }
  vec2 bytes = floor(texelFetch(map, pixel, 0).rg * 255.0 + 0.5);
  float number = bytes.r * 256.0 + bytes.g;
  return number == 0.0 ? UNKNOWN : uSmallest + (number - 1.0) * uStep;
}

// False where either is unknown.
bool isOneSurface(float a, float b) {
  return a != UNKNOWN && abs(a - b) <= uGradientLimit;
}
