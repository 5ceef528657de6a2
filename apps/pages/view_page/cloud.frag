// A point of the cloud. Where points of one surface overlap, that with the nearer centre is seen:
// the farther from its centre, the deeper, by about a hundredth of the pivot's depth.

flat in vec3 vColour;
out vec4 oColour;

const float DEEPER_AT_EDGES = 1.0e-4;

void main() {
  vec2 place = 2.0 * gl_PointCoord - 1.0;
  gl_FragDepth = gl_FragCoord.z + DEEPER_AT_EDGES * dot(place, place);
  oColour = vec4(vColour, 1.0);
}
