// Third pass: a hole takes the surface on its background side, the end of smaller disparity along
// the row, mirrored at the edge of the hole. Colours are copied, never mixed; alpha 0 tells where.

uniform sampler2D uColour;
uniform highp usampler2D uDisparity;
uniform bool uMirror;  // else the pixel at the edge is repeated
// The last pixel of the background, often a mixture with what hid the rest, is filled as well.
uniform bool uFillsMixedPixels;

layout(location = 0) out vec4 oColour;
layout(location = 1) out uint oDisparity;

ivec2 position;

// The disparity so many columns to the right; beyond the border as in a hole.
float disparityBeside(int columns) {
  int x = position.x + columns;
  return x < 0 || x >= uSize.x
      ? UNKNOWN
      : uintBitsToFloat(texelFetch(uDisparity, ivec2(x, position.y), 0).r);
}

// Columns from a hole, itself so many columns to the right, to the first pixel in a direction (1
// or -1) that is none; 0 if there is none.
int findEdge(int hole, int direction) {
  int x = position.x + hole;
  int room = direction > 0 ? uSize.x - 1 - x : x;
  for (int k = 1; k <= room; ++k) {
    if (disparityBeside(hole + direction * k) != UNKNOWN) {
      return k;
    }
  }
  return 0;
}

// The background of the hole so many columns to the right: in which direction it lies (0: there
// is none) and how many columns from the hole it begins.
void findBackground(int hole, out int direction, out int edge) {
  int left = findEdge(hole, -1);
  int right = findEdge(hole, 1);
  float ofLeft = disparityBeside(hole - left);
  float ofRight = disparityBeside(hole + right);
  direction = left > 0 && !(right > 0 && ofRight < ofLeft) ? -1 : right > 0 ? 1 : 0;
  edge = direction < 0 ? left : right;
  if (uFillsMixedPixels && left > 0 && right > 0 && !isOneSurface(ofLeft, ofRight)
      && isOneSurface(disparityBeside(hole + direction * edge),
                      disparityBeside(hole + direction * (edge + 1)))) {
    ++edge;
  }
}

// Columns from the background's beginning to the pixel that fills number `wanted`, counted from
// there: s0, s1, ... to and fro within the surface.
int source(int begin, int direction, int wanted) {
  if (!uMirror) {
    return 0;
  }
  int run = 1;
  while (run <= wanted && isOneSurface(disparityBeside(begin + direction * run),
                                       disparityBeside(begin + direction * (run - 1)))) {
    ++run;
  }
  int turn = wanted % (2 * run);
  return direction * (turn < run ? turn : 2 * run - 1 - turn);
}

void main() {
  position = ivec2(gl_FragCoord.xy);
  int from = 0;
  int begin = 0;
  if (disparityBeside(0) == UNKNOWN) {
    int direction;
    int edge;
    findBackground(0, direction, edge);
    if (direction != 0) {
      begin = direction * edge;
      from = begin + source(begin, direction, edge - 1);
    }
  } else if (uFillsMixedPixels) {
    // It belongs to a hole beside it if that one's background begins a pixel farther.
    for (int hole = -1; hole <= 1; hole += 2) {
      int direction;
      int edge;
      if (position.x + hole >= 0 && position.x + hole < uSize.x
          && disparityBeside(hole) == UNKNOWN) {
        findBackground(hole, direction, edge);
        if (direction == -hole && edge == 2) {
          from = begin = direction;
        }
      }
    }
  }
  oColour = texelFetch(uColour, position + ivec2(from, 0), 0);
  oColour.a = from == 0 ? oColour.a : 0.0;
  oDisparity = texelFetch(uDisparity, position + ivec2(begin, 0), 0).r;
}
