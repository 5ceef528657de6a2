// First pass, one image at a time: every pixel of its disparity map becomes a point that covers
// where the pixel lands in the new view, p - d * s, and what opens between it and its neighbours to
// the right and below, a quad of four, on the same surface. The depth test on d lets the nearest
// win.

uniform sampler2D uMap;
uniform vec2 uShift;  // s: from this image's camera to the new view, in baselines
uniform int uMargin;  // pixels around the view, see warp.frag
uniform ivec2 uTargetSize;

flat out ivec2 vPixel;
// Exact places of the four corners relative to the pixel: large coordinates would cost the digits
// that sub-pixel positions need.
flat out vec4 vPlaces01;
flat out vec4 vPlaces23;
flat out vec4 vDisparities;

const ivec2 CORNERS[4] = ivec2[4](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));

void main() {
  vPixel = ivec2(gl_VertexID % uSize.x, gl_VertexID / uSize.x);
  vec2 place[4];
  vec4 d;
  for (int k = 0; k < 4; ++k) {
    d[k] = disparityAt(uMap, vPixel + CORNERS[k]);
    if (d[k] == UNKNOWN && uShift == vec2(0.0) && all(lessThan(vPixel + CORNERS[k], uSize))) {
      d[k] = uSmallest;  // at the camera's own place a pixel is seen whatever its disparity
    }
    place[k] = vec2(CORNERS[k]) - uShift * d[k];
  }
  vPlaces01 = vec4(place[0], place[1]);
  vPlaces23 = vec4(place[2], place[3]);
  vDisparities = d;

  // Corners whose targets span all that may be covered. Corners that are on another surface than
  // the pixel, but on one themselves, have a point of their own, the second instance: one point for
  // both would cover all that is between the surfaces.
  bool right = isOneSurface(d[0], d[1]);
  bool below = isOneSurface(d[0], d[2]);
  bvec4 isCovered = bvec4(gl_InstanceID == 0 && d[0] != UNKNOWN, false, false, false);
  if (uShift.y == 0.0) {
    isCovered[1] = right && place[1].x > place[0].x;  // else it is seen from behind
  } else {
    bool isLast = isOneSurface(d[1], d[3]) && isOneSurface(d[2], d[3]);
    if (gl_InstanceID == 0 && (right || below)) {
      isCovered[1] = right || isLast;
      isCovered[2] = below || isLast;
      isCovered[3] = isLast || (right && isOneSurface(d[1], d[3]))
                            || (below && isOneSurface(d[2], d[3]));
    } else if (gl_InstanceID == 1 && !right && !below) {
      isCovered = bvec4(false, isLast, isLast, isLast);
    }
  }
  vec2 low = vec2(1.0e9);
  vec2 high = vec2(-1.0e9);
  for (int k = 0; k < 4; ++k) {
    if (isCovered[k]) {
      low = min(low, floor(place[k] + 0.5));
      high = max(high, floor(place[k] + 0.5));
    }
  }
  if (high.x < low.x) {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);  // nothing: outside, where points are dropped
    gl_PointSize = 1.0;
    return;
  }
  if (uShift.y == 0.0) {
    high.x = max(high.x - 1.0, low.x);  // the neighbour's target has a point already
  }
  float side = max(high.x - low.x, high.y - low.y) + 1.0;
  vec2 centre = vec2(vPixel + uMargin) + low + 0.5 * side;
  gl_Position = vec4(centre / vec2(uTargetSize) * 2.0 - 1.0, 0.0, 1.0);
  gl_PointSize = side;
}
