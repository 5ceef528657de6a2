// The disparity that a point of warp.vert shows at one position of the new view: the largest of
// what lands there.

uniform vec2 uShift;
// A point is dropped when its centre is outside the target, whatever part of it is inside. The
// margin keeps those centres inside.
uniform int uMargin;

flat in ivec2 vPixel;
flat in vec4 vPlaces01;
flat in vec4 vPlaces23;
flat in vec4 vDisparities;

// Bits of a float: integer targets can be rendered to everywhere, float targets cannot.
out uint oDisparity;

const float NOTHING = -UNKNOWN;

// Between the targets of two neighbours of one surface, along the row (axis 0) or column (axis 1).
float inGap(vec2 at, vec2 a, vec2 b, float da, float db, int axis) {
  int other = 1 - axis;
  if (!isOneSurface(da, db) || at[axis] <= floor(a[axis] + 0.5)
      || at[axis] >= floor(b[axis] + 0.5)) {
    return NOTHING;
  }
  float fraction = (at[axis] - a[axis]) / (b[axis] - a[axis]);
  return at[other] == floor(mix(a[other], b[other], fraction) + 0.5) ? mix(da, db, fraction)
                                                                     : NOTHING;
}

float cross2(vec2 a, vec2 b) {
  return a.x * b.y - a.y * b.x;
}

// In a triangle, unless it is seen from behind.
float inTriangle(vec2 at, vec2 a, vec2 b, vec2 c, float da, float db, float dc) {
  float area = cross2(b - a, c - a);
  if (area <= 1.0e-6) {
    return NOTHING;
  }
  vec3 weight = vec3(cross2(b - at, c - at), cross2(c - at, a - at), cross2(a - at, b - at)) / area;
  // Neighbours must not leave a position on their common edge to each other.
  return all(greaterThanEqual(weight, vec3(-1.0e-5))) ? dot(weight, vec3(da, db, dc)) : NOTHING;
}

float inQuad(vec2 at, vec2 a, vec2 b, vec2 c, vec2 d, vec4 disparity) {
  // A corner's target shows the corner and nothing interpolated.
  if (at == floor(a + 0.5) || at == floor(b + 0.5) || at == floor(c + 0.5)
      || at == floor(d + 0.5)) {
    return NOTHING;
  }
  float da = disparity[0];
  float db = disparity[1];
  float dc = disparity[2];
  float dd = disparity[3];
  bool ab = isOneSurface(da, db);
  bool ac = isOneSurface(da, dc);
  bool bd = isOneSurface(db, dd);
  bool cd = isOneSurface(dc, dd);
  float result = NOTHING;
  if (ab && ac) {
    result = max(result, inTriangle(at, a, b, c, da, db, dc));
  }
  if (bd && cd) {
    result = max(result, inTriangle(at, b, d, c, db, dd, dc));
  }
  if (!(ab && ac && bd && cd)) {
    if (ab && bd) {
      result = max(result, inTriangle(at, a, b, d, da, db, dd));
    }
    if (ac && cd) {
      result = max(result, inTriangle(at, a, d, c, da, dd, dc));
    }
  }
  return result;
}

void main() {
  vec2 at = vec2(ivec2(gl_FragCoord.xy) - uMargin - vPixel);
  vec4 d = vDisparities;
  vec2 a = vPlaces01.xy;
  vec2 b = vPlaces01.zw;
  float nearest = d[0] != UNKNOWN && at == floor(a + 0.5) ? d[0] : NOTHING;
  nearest = max(nearest, inGap(at, a, b, d[0], d[1], 0));
  if (uShift.y != 0.0) {
    vec2 c = vPlaces23.xy;
    nearest = max(nearest, inGap(at, a, c, d[0], d[2], 1));
    nearest = max(nearest, inQuad(at, a, b, c, vPlaces23.zw, d));
  }
  if (nearest == NOTHING) {
    discard;
  }
  gl_FragDepth = clamp(0.75 - 0.5 * (nearest - uSmallest) / (uStep * 65535.0), 0.0, 1.0);
  oDisparity = floatBitsToUint(nearest);
}
