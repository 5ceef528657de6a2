// A screen in space before the viewer, as one eye sees it; x and y are around its middle, in metres.

uniform mat4 uProjection;
uniform mat4 uEye;       // from space to the eye
uniform vec2 uHalfSize;
uniform float uDistance;
uniform vec2 uMoved;     // by how much of the picture's size the screen's surface moved in the view

out vec2 vPlace;

void main() {
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2);  // from the left and from the top
  vPlace = corner - uMoved;
  vec2 place = uHalfSize * vec2(2.0 * corner.x - 1.0, 1.0 - 2.0 * corner.y);
  gl_Position = uProjection * uEye * vec4(place, -uDistance, 1.0);
}
