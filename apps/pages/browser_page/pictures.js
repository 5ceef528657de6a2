"use strict";

// From files of people to the two pictures that are matched, with what was done on the way.

class PictureError extends Error {}

const Pictures = {
  async decode(file) {
    try {
      // Values as in the file: colours of a display are no matter of matching.
      return await createImageBitmap(file, {colorSpaceConversion: "none",
                                            premultiplyAlpha: "none"});
    } catch {
      throw new PictureError(`${file.name}: this browser cannot read it as a picture`);
    }
  },

  // The parts of one picture with both eyes: [x, y, width, height] of the left and the right one.
  parts({width, height}, packing, notes) {
    const isAbove = packing === "above" || (packing === "auto" && height > width);
    if (packing === "auto") {
      notes.push(`one picture of ${width}×${height}: its ` +
                 (isAbove ? "upper half is the left eye's" : "left half is the left eye's"));
    }
    const [w, h] = isAbove ? [width, height >> 1] : [width >> 1, height];
    if (isAbove ? height % 2 : width % 2) {
      notes.push(`${isAbove ? "the last row" : "the last column"} is left out, to have two halves`);
    }
    return [[0, 0, w, h], isAbove ? [0, h, w, h] : [w, 0, w, h]];
  },

  // A part of a bitmap as RGBA, of `width` × `height` pixels.
  pixels(bitmap, [x, y, w, h], width, height) {
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext("2d", {willReadFrequently: true});
    context.imageSmoothingQuality = "high";
    context.drawImage(bitmap, x, y, w, h, 0, 0, width, height);
    return context.getImageData(0, 0, width, height);
  },

  // {left, right, notes} of one or two files.
  async prepare(files, {packing, isExchanged, megapixels}) {
    const notes = [];
    const bitmaps = await Promise.all(files.map((file) => Pictures.decode(file)));
    const whole = ({width, height}) => [0, 0, width, height];
    const places = files.length === 1 ? Pictures.parts(bitmaps[0], packing, notes)
      : bitmaps.map(whole);
    const [[, , width, height], [, , otherWidth, otherHeight]] = places;
    if (width !== otherWidth || height !== otherHeight) {
      throw new PictureError(`${files[0].name} has ${width}×${height} pixels, ${files[1].name} ` +
                             `${otherWidth}×${otherHeight}; both must have the same size`);
    }
    const scale = Math.min(1, Math.sqrt(megapixels * 1e6 / (width * height)));
    const size = [width, height].map((side) => Math.max(Math.round(side * scale), 1));
    if (scale < 1) {
      notes.push(`pictures of ${width}×${height} were reduced to ${size.join("×")} pixels`);
    }
    const pictures = places.map((place, k) => Pictures.pixels(bitmaps[k] ?? bitmaps[0], place,
                                                              ...size));
    bitmaps.forEach((bitmap) => bitmap.close());
    if (isExchanged) {
      pictures.reverse();
      notes.push("the eyes are exchanged");
    }
    return {left: pictures[0], right: pictures[1], notes};
  },

  // A map as a PFM file: rows from the lowest, as floats of this machine's order (browsers run on
  // little-endian ones only).
  pfm(map, width, height) {
    const rows = [`Pf\n${width} ${height}\n-1.0\n`];
    for (let y = height - 1; y >= 0; --y) {
      rows.push(map.subarray(y * width, (y + 1) * width));
    }
    return new Blob(rows);
  },
};
