"use strict";

// The frames of a page, and when each is shown. A pair is a film of one frame, which is in the page.
// Frames of other films are scripts in a folder beside it: a page on a disk may load these, but
// neither read files nor draw their pictures with WebGL. Each calls Film.deliver(). A few frames are
// decoded ahead of the one that is shown, and freed behind it.

class Film {
  // scene: the numbers of the page. show(frame): called when it is a frame's turn, with the numbers
  // and pictures that Renderer.setFrame() takes, or with a problem instead.
  constructor(scene, show) {
    Object.assign(this, scene.film);  // folder, frames, rate
    this.show = show;
    const bytes = 4 * 4 * scene.width * scene.height;
    this.ahead = Math.min(Math.max(Math.floor(Film.DECODED_BYTES / bytes) - 1, 1), Film.MOST_AHEAD,
                          this.frames.length - 1);
    this.kept = new Map();  // index => {frame, done}; the frame is undefined until it is decoded
    this.index = -1;        // of the frame that is shown
    this.wanted = -1;       // where it is going
    this.isGoing = false;
    this.isPlaying = false;
    this.speed = 1;
    this.shownAt = 0;       // milliseconds
  }

  static deliver(number, frame) {
    Film.delivered.set(number, frame);
  }

  // Shows a frame as soon as it is decoded; of several in a row those that there is time for.
  async goTo(index) {
    this.wanted = (index + this.frames.length) % this.frames.length;
    if (this.isGoing) {
      return;
    }
    this.isGoing = true;
    while (this.index !== this.wanted) {
      const next = this.wanted;
      await this.fetch(next).done;
      this.present(next);
    }
    this.isGoing = false;
  }

  // Shows the next frame if it is time, and it is there: every frame has its turn, so a film that
  // cannot be decoded as fast as it should be plays more slowly.
  advance(time) {
    const next = (this.index + 1) % this.frames.length;
    const period = 1000 / (this.rate * this.speed);
    if (this.isPlaying && !this.isGoing && time >= this.shownAt + period - Film.EARLY_MS
        && this.fetch(next).frame) {
      this.shownAt = Math.max(this.shownAt + period, time - period);
      this.wanted = next;
      this.present(next);
    }
  }

  present(index) {
    this.index = index;
    const {frame} = this.kept.get(index);
    const wanted = new Set();
    for (let k = 0; k <= (index === this.wanted ? this.ahead : 0); ++k) {
      wanted.add((index + k) % this.frames.length);
    }
    for (const [other, entry] of this.kept) {
      if (!wanted.has(other)) {
        this.kept.delete(other);
        Film.free(entry.frame);
      }
    }
    this.show(frame);
    wanted.forEach((other) => this.fetch(other));
  }

  fetch(index) {
    if (!this.kept.has(index)) {
      const entry = {};
      entry.done = this.load(this.frames[index]).then((frame) => {
        entry.frame = frame;
        if (this.kept.get(index) !== entry) {
          Film.free(frame);  // nobody waits for it any more
        }
      });
      this.kept.set(index, entry);
    }
    return this.kept.get(index);
  }

  async load({number, problem}) {
    const file = `${this.folder}/${String(number).padStart(6, "0")}.js`;
    if (!problem && this.folder) {
      await Film.runScript(file);
    }
    const frame = Film.delivered.get(number);
    Film.delivered.delete(number);
    if (!frame) {
      return {number, problem: problem || `${file} cannot be loaded; it belongs beside this page`};
    }
    try {
      const pictures = await Promise.all(
        [[frame.type, "left"], [frame.type, "right"], ["image/png", "leftMap"],
         ["image/png", "rightMap"]].map(async ([type, name]) =>
          [name, await Film.decode(`data:${type};base64,${frame[name]}`)]));
      return {number, disparity: frame.disparity, intensity: frame.intensity,
              pictures: Object.fromEntries(pictures)};
    } catch (error) {
      return {number, problem: `a picture of it is damaged (${error.message})`};
    }
  }

  static runScript(file) {
    return new Promise((resolve) => {
      const script = document.createElement("script");
      script.onload = script.onerror = () => {
        script.remove();
        resolve();
      };
      script.src = file;
      document.head.append(script);
    });
  }

  // The values as they are in the file: colour management would change bytes that are no colours.
  static async decode(address) {
    return createImageBitmap(await (await fetch(address)).blob(),
                             {colorSpaceConversion: "none", premultiplyAlpha: "none"});
  }

  static free(frame) {
    Object.values(frame?.pictures ?? {}).forEach((picture) => picture.close());
  }
}

Film.delivered = new Map();  // number => what its script holds
Film.DECODED_BYTES = 256 * 1024 * 1024;
Film.MOST_AHEAD = 15;
Film.EARLY_MS = 4;  // a quarter of what screens show a picture: the nearer one is taken
