// Last pass: a row without any pixel takes the nearest row that has some, the upper of two.

uniform sampler2D uColour;
uniform highp usampler2D uDisparity;

layout(location = 0) out vec4 oColour;
layout(location = 1) out uint oDisparity;

bool isKnown(ivec2 position) {
  return position.y >= 0 && position.y < uSize.y
      && uintBitsToFloat(texelFetch(uDisparity, position, 0).r) != UNKNOWN;
}

void main() {
  ivec2 position = ivec2(gl_FragCoord.xy);
  ivec2 from = position;
  if (!isKnown(position)) {
    for (int k = 1; k < uSize.y; ++k) {
      if (isKnown(position - ivec2(0, k))) {
        from.y -= k;
        break;
      }
      if (isKnown(position + ivec2(0, k))) {
        from.y += k;
        break;
      }
    }
  }
  oColour = vec4(texelFetch(uColour, from, 0).rgb, 1.0);
  oDisparity = texelFetch(uDisparity, from, 0).r;
}
