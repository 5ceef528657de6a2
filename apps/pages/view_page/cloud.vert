// The left photograph's pixels as points in space, seen by a camera that turns around them. Lengths
// are such that a pixel's depth is focal length / (d + doffs).

uniform sampler2D uMap;
uniform sampler2D uPicture;
uniform mat3 uRotation;      // of the points around the pivot
uniform vec3 uPivot;
uniform vec3 uEye;           // in the turned frame, with the pivot at the origin
uniform float uFocal;        // in pixels of the photograph
uniform vec2 uCentre;        // principal point
uniform float uDoffs;
uniform float uFarthest;     // depth beyond which nothing is drawn
uniform vec2 uCanvas;        // its size in pixels
uniform float uScale;        // pixels of the canvas per pixel of the photograph, at the start

flat out vec3 vColour;

const ivec2 SIDES[4] = ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

void main() {
  ivec2 pixel = ivec2(gl_VertexID % uSize.x, gl_VertexID / uSize.x);
  float d = disparityAt(uMap, pixel);
  bool isShown = d != UNKNOWN && d + uDoffs > 0.0;
  for (int k = 0; k < 4; ++k) {
    float beside = disparityAt(uMap, pixel + SIDES[k]);
    // At outlines a pixel mixes two surfaces: it would hang between them.
    isShown = isShown && (beside == UNKNOWN || isOneSurface(d, beside));
  }
  float depth = uFocal / max(d + uDoffs, 1.0e-6);
  if (!isShown || depth > uFarthest) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside
    gl_PointSize = 1.0;
    return;
  }
  vec3 point = vec3((vec2(pixel) - uCentre) / uFocal, 1.0) * depth;
  vec3 seen = uRotation * (point - uPivot) - uEye;
  float nearest = 0.01 * uPivot.z;
  float farthest = 4.0 * uFarthest;
  // In pixels of the canvas from its middle; the start shows the photograph as it is.
  vec2 middle = uCentre - 0.5 * (vec2(uSize) - 1.0);
  vec2 place = uScale * (uFocal * seen.xy + middle * seen.z);
  gl_Position = vec4(2.0 * place.x / uCanvas.x, -2.0 * place.y / uCanvas.y,
                     (seen.z * (farthest + nearest) - 2.0 * farthest * nearest) /
                         (farthest - nearest), seen.z);
  // As large as its pixel is there, and a little more: slanted surfaces have gaps otherwise.
  gl_PointSize = clamp(1.6 * uScale * depth / max(seen.z, nearest), 1.0, 64.0);
  vColour = texelFetch(uPicture, pixel, 0).rgb;
}
