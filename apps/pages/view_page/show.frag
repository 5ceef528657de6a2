// Onto the screen, scaled: a picture, two as an anaglyph, or disparities in colours.

uniform sampler2D uPicture;
uniform sampler2D uRightPicture;
uniform highp usampler2D uDisparity;
uniform sampler2D uPalette;
uniform vec2 uPaletteRange;  // disparities of its first and last colour
uniform int uKind;           // 0 picture, 1 anaglyph, 2 disparities

uniform vec2 uColumns;       // first and number of the columns shown, as parts of the width
uniform vec2 uRightColumns;  // of the right eye's picture

in vec2 vPlace;
out vec4 oColour;

// Dubois' least-squares matrices for red and cyan glasses, by columns.
const mat3 LEFT_EYE = mat3(0.4561, -0.0401, -0.0152, 0.5005, -0.0378, -0.0206,
                           0.1764, -0.0158, -0.0055);
const mat3 RIGHT_EYE = mat3(-0.0435, 0.3785, -0.0722, -0.0879, 0.7336, -0.1130,
                            -0.0016, -0.0184, 1.2264);

void main() {
  vec2 place = vec2(uColumns.x + vPlace.x * uColumns.y, vPlace.y);
  vec2 rightPlace = vec2(uRightColumns.x + vPlace.x * uRightColumns.y, vPlace.y);
  vec3 colour = texture(uPicture, place).rgb;
  if (uKind == 1) {
    colour = clamp(LEFT_EYE * colour + RIGHT_EYE * texture(uRightPicture, rightPlace).rgb, 0.0, 1.0);
  } else if (uKind == 2) {
    ivec2 pixel = min(ivec2(place * vec2(uSize)), uSize - 1);
    float d = uintBitsToFloat(texelFetch(uDisparity, pixel, 0).r);
    float t = (d - uPaletteRange.x) / (uPaletteRange.y - uPaletteRange.x);
    int colourNumber = int(clamp(t, 0.0, 1.0) * 255.0 + 0.5);
    colour = d == UNKNOWN ? vec3(0.0) : texelFetch(uPalette, ivec2(colourNumber, 0), 0).rgb;
  }
  oColour = vec4(colour, 1.0);
}
