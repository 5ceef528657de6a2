// Onto the screen, scaled: a picture, or disparities in colours.

uniform sampler2D uPicture;
uniform highp usampler2D uDisparity;
uniform sampler2D uPalette;
uniform vec2 uPaletteRange;  // disparities of its first and last colour
uniform bool uShowsDisparities;

in vec2 vPlace;
out vec4 oColour;

void main() {
  if (any(lessThan(vPlace, vec2(0.0))) || any(greaterThan(vPlace, vec2(1.0)))) {
    oColour = vec4(0.0, 0.0, 0.0, 1.0);  // of a screen in space, which does not move with the view
    return;
  }
  vec3 colour = texture(uPicture, vPlace).rgb;
  if (uShowsDisparities) {
    ivec2 pixel = min(ivec2(vPlace * vec2(uSize)), uSize - 1);
    float d = uintBitsToFloat(texelFetch(uDisparity, pixel, 0).r);
    float t = (d - uPaletteRange.x) / (uPaletteRange.y - uPaletteRange.x);
    int colourNumber = int(clamp(t, 0.0, 1.0) * 255.0 + 0.5);
    colour = d == UNKNOWN ? vec3(0.0) : texelFetch(uPalette, ivec2(colourNumber, 0), 0).rgb;
  }
  oColour = vec4(colour, 1.0);
}
