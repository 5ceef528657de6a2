"use strict";

// Runs the matcher in a worker, so that the page stays alive: the C interface
// (engine/library/vantage_c.h), and what browser_page.cc adds for the page. One message is one task.
//   {example: [width, height]}   => {left, right}: pictures
//   {left, right, options}       => {map, range, colours, remarks, milliseconds}, then
//                                   {page}: the text of the page that renders views
// A picture is {width, height, data}, data RGBA. Each task may end with {error}: a line for people.

const STRUCT_BYTES = 36;  // of vantage_image and vantage_picture: nine words of 32 bits

class Task {
  constructor(engine) {
    this.engine = engine;
    this.addresses = [];  // freed at the end
  }

  call(name, type, ...values) {
    const types = values.map((value) => typeof value);
    return this.engine.ccall(name, type, types, values);
  }

  // Calls a function of the C interface that returns a vantage_status.
  check(name, ...values) {
    if (this.call(name, "number", ...values) !== 0) {
      throw new Error(this.call("vantage_last_error", "string"));
    }
  }

  allocate(bytes) {
    const address = this.engine._malloc(bytes);
    if (!address) {
      throw new Error("there is no memory for pictures of this size; choose a smaller size");
    }
    this.addresses.push(address);
    return address;
  }

  free() {
    this.addresses.forEach((address) => this.engine._free(address));
  }

  // A struct of pixels at `address`.
  struct(address, {width, height}, channels, bits) {
    const struct = this.allocate(STRUCT_BYTES);
    this.engine.HEAP32.set([STRUCT_BYTES, address, width, height, 0, channels, bits, 0, 0],
                           struct / 4);
    return struct;
  }

  imageOf(picture) {
    const {data, width, height} = picture;
    const address = this.allocate(3 * width * height);
    const bytes = this.engine.HEAPU8;
    for (let from = 0, to = address; from < data.length; from += 4) {
      bytes[to++] = data[from];
      bytes[to++] = data[from + 1];
      bytes[to++] = data[from + 2];
    }
    return this.struct(address, picture, 3, 8);
  }

  // The handle that a function writes to its last parameter.
  handleOf(name, ...values) {
    const place = this.allocate(4);
    this.check(name, ...values, place);
    return this.engine.HEAPU32[place / 4];
  }

  matcher(options) {
    const texts = options.map((option) => {
      const bytes = new TextEncoder().encode(`${option}\0`);
      const address = this.allocate(bytes.length);
      this.engine.HEAPU8.set(bytes, address);
      return address;
    });
    const list = this.allocate(4 * texts.length);
    this.engine.HEAPU32.set(texts, list / 4);
    return this.handleOf("vantage_matcher_create", list, texts.length);
  }

  // One float for each pixel of the left image.
  disparities(pair, size) {
    const count = size.width * size.height;
    const address = this.allocate(4 * count);
    this.check("vantage_pair_disparity", pair, 0, this.struct(address, size, 1, 32));
    return this.engine.HEAPF32.slice(address / 4, address / 4 + count);
  }

  remarks(pair) {
    const isWarning = this.allocate(4);
    const remarks = [];
    for (let text; (text = this.call("vantage_pair_remark", "string", pair, remarks.length,
                                     isWarning));) {
      remarks.push({text, isWarning: this.engine.HEAP32[isWarning / 4] === 1});
    }
    return remarks;
  }

  // Calls a function of browser_page.cc that returns 0 if it fails.
  made(name, type, ...values) {
    const result = this.call(name, type, ...values);
    if (!result) {
      throw new Error(this.call("browser_error", "string"));
    }
    return result;
  }

  picture(index) {
    const size = this.allocate(8);
    const address = this.call("browser_picture", "number", index, size);
    const [width, height] = this.engine.HEAP32.subarray(size / 4, size / 4 + 2);
    const data = new Uint8ClampedArray(this.engine.HEAPU8.slice(address,
                                                                address + 4 * width * height));
    return new ImageData(data, width, height);
  }

  colours(pair) {
    const range = this.allocate(8);
    this.made("browser_colours", "number", pair, range);
    return {colours: this.picture(0), range: [...this.engine.HEAPF32.subarray(range / 4,
                                                                              range / 4 + 2)]};
  }

  // The encoder of the browser makes the PNG files that the page has in it.
  async viewPage(pair, names) {
    const page = this.made("browser_view_page", "string", pair, names);
    const parts = page.split(/@picture (\d+)@/);
    for (let index = 1; index < parts.length; index += 2) {
      const picture = this.picture(Number(parts[index]));
      const canvas = new OffscreenCanvas(picture.width, picture.height);
      canvas.getContext("2d").putImageData(picture, 0, 0);
      parts[index] = new FileReaderSync().readAsDataURL(await canvas.convertToBlob()).split(",")[1];
    }
    return parts.join("");
  }

  async match({left, right, options, names}, answer) {
    const matcher = this.matcher(options);
    let pair = 0;
    try {
      const images = [this.imageOf(left), this.imageOf(right)];
      const start = performance.now();
      pair = this.handleOf("vantage_match", matcher, ...images);
      const milliseconds = performance.now() - start;
      answer({
        milliseconds, remarks: this.remarks(pair), ...this.colours(pair),
        map: this.disparities(pair, left),
      });
      answer({page: await this.viewPage(pair, names)});
    } finally {
      this.call("vantage_pair_destroy", null, pair);
      this.call("vantage_matcher_destroy", null, matcher);
    }
  }

  example([width, height], answer) {
    this.made("browser_example", "number", width, height);
    answer({left: this.picture(0), right: this.picture(1)});
  }
}

const started = makeEngine();

onmessage = async ({data: {number, ...task}}) => {
  const answer = (result) => postMessage({number, ...result});
  let running = null;
  try {
    running = new Task(await started);
    await (task.example ? running.example(task.example, answer) : running.match(task, answer));
  } catch (error) {
    answer({error: error.message ?? String(error)});
  } finally {
    running?.free();
  }
};
