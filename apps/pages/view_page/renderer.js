"use strict";

// Draws new views of a rectified pair with WebGL 2: each disparity map is warped to the new
// position, colours are fetched from the photographs, blended, and holes filled. The shaders say
// how; this file connects them.

class RendererError extends Error {}

class Renderer {
  // scene: the numbers of the page. palette: its picture of colours. shaderText: name => text.
  constructor(gl, scene, palette, shaderText) {
    this.gl = gl;
    this.scene = scene;
    const largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    this.margin = this.marginOf(scene);
    this.targetSize = [scene.width + 2 * this.margin, scene.height + 2 * this.margin];
    if (Math.max(...this.targetSize) > largest) {
      throw new RendererError(`This picture has ${scene.width}×${scene.height} pixels; the ` +
                              `graphics of this browser draw at most ${largest} on a side.`);
    }
    const screen = shaderText("screen.vert");
    this.programs = {
      warp: this.makeProgram(shaderText("warp.vert"), shaderText("warp.frag")),
      combine: this.makeProgram(screen, shaderText("combine.frag")),
      fill: this.makeProgram(screen, shaderText("fill.frag")),
      interpolate: this.makeProgram(screen, shaderText("interpolate.frag")),
      soften: this.makeProgram(screen, shaderText("soften.frag")),
      outlines: this.makeProgram(screen, shaderText("outlines.frag")),
      rows: this.makeProgram(screen, shaderText("rows.frag")),
      show: this.makeProgram(screen, shaderText("show.frag")),
      cloud: this.makeProgram(shaderText("cloud.vert"), shaderText("cloud.frag")),
      headset: this.makeProgram(shaderText("headset.vert"), shaderText("show.frag")),
    };
    const {width, height} = scene;
    this.textures = {
      left: this.makeTexture(gl.RGBA8, width, height, gl.LINEAR),
      right: this.makeTexture(gl.RGBA8, width, height, gl.LINEAR),
      leftMap: this.makeTexture(gl.RGBA8, width, height, gl.NEAREST),
      rightMap: this.makeTexture(gl.RGBA8, width, height, gl.NEAREST),
      palette: this.makeTexture(gl.RGBA8, palette.naturalWidth, 1, gl.NEAREST),
    };
    this.fill("palette", palette);
    this.frame = null;
    this.warped = [this.makeWarpTarget(), this.makeWarpTarget()];
    this.steps = [this.makeViewTarget(), this.makeViewTarget()];
    this.view = this.makeViewTarget();
  }

  // A point of warp.vert grows by what neighbours of one surface move apart.
  marginOf(scene) {
    const farthest = Math.max(...scene.rangeX.map((x) => Math.max(Math.abs(x), Math.abs(x - 1))),
                              ...scene.rangeY.map(Math.abs));
    return 3 + Math.ceil(farthest * scene.gradientLimit);
  }

  makeProgram(vertexText, fragmentText) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
        throw new RendererError(`A shader does not compile: ${gl.getShaderInfoLog(shader)}`);
      }
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new RendererError(`Shaders do not link: ${gl.getProgramInfoLog(program)}`);
    }
    const uniforms = {};
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const info = gl.getActiveUniform(program, i);
      uniforms[info.name] = {type: info.type, location: gl.getUniformLocation(program, info.name)};
    }
    return {program, uniforms};
  }

  makeTexture(format, width, height, filter) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, filter === gl.NEAREST ? 1 : this.levelsOf(width, height),
                    format, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER,
                     filter === gl.NEAREST ? gl.NEAREST : gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  levelsOf(width, height) {
    return 1 + Math.floor(Math.log2(Math.max(width, height)));
  }

  // What is shown from now on. frame: its pictures by name, and the numbers that go with them.
  setFrame(frame) {
    this.frame = frame;
    for (const [name, picture] of Object.entries(frame.pictures)) {
      this.fill(name, picture);
      if (name === "left" || name === "right") {
        this.gl.generateMipmap(this.gl.TEXTURE_2D);
      }
    }
  }

  // The values as they are in the file, see Film.decode().
  fill(name, picture) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  }

  // Disparities that one image shows in the new view.
  makeWarpTarget() {
    const gl = this.gl;
    const disparity = this.makeTexture(gl.R32UI, ...this.targetSize, gl.NEAREST);
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, disparity, 0);
    const depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, ...this.targetSize);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    return {framebuffer, disparity};
  }

  // A new view: colours and disparities.
  makeViewTarget() {
    const gl = this.gl;
    const {width, height} = this.scene;
    const colour = this.makeTexture(gl.RGBA8, width, height, gl.LINEAR);
    const disparity = this.makeTexture(gl.R32UI, width, height, gl.NEAREST);
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, disparity, 0);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    return {framebuffer, colour, disparity};
  }

  // Makes `program` current with these values. Textures take units in the order they come.
  use(program, values) {
    const gl = this.gl;
    gl.useProgram(program.program);
    const all = {
      uSmallest: this.frame.disparity.smallest,
      uStep: this.frame.disparity.step,
      uSize: [this.scene.width, this.scene.height],
      uGradientLimit: this.scene.gradientLimit,
      ...values,
    };
    let unit = 0;
    for (const [name, {type, location}] of Object.entries(program.uniforms)) {
      const value = all[name];
      switch (type) {
        case gl.SAMPLER_2D:
        case gl.UNSIGNED_INT_SAMPLER_2D:
          gl.activeTexture(gl.TEXTURE0 + unit);
          gl.bindTexture(gl.TEXTURE_2D, value);
          gl.uniform1i(location, unit++);
          break;
        case gl.FLOAT: gl.uniform1f(location, value); break;
        case gl.FLOAT_VEC2: gl.uniform2fv(location, value); break;
        case gl.FLOAT_VEC3: gl.uniform3fv(location, value); break;
        case gl.FLOAT_MAT3: gl.uniformMatrix3fv(location, false, value); break;
        case gl.FLOAT_MAT4: gl.uniformMatrix4fv(location, false, value); break;
        case gl.INT_VEC2: gl.uniform2iv(location, value); break;
        default: gl.uniform1i(location, value);  // int and bool
      }
    }
  }

  // Renders the view at (x, y), in baselines from the left camera.
  render(x, y) {
    const gl = this.gl;
    const shifts = [[x, y], [x - 1, y]];
    this.warp(this.warped[0], this.textures.leftMap, shifts[0]);
    this.warp(this.warped[1], this.textures.rightMap, shifts[1]);

    const blending = this.blending(shifts);
    // At a camera's own place its photograph is not touched.
    const softens = this.scene.softEdges && blending.uAlpha > 0 && blending.uAlpha < 1;
    const warped = {
      uLeftMap: this.textures.leftMap,
      uRightMap: this.textures.rightMap,
      uLeftWarped: this.warped[0].disparity,
      uRightWarped: this.warped[1].disparity,
      uLeftShift: shifts[0],
      uRightShift: shifts[1],
      uMargin: this.margin,
      ...blending,
    };
    const passes = [["combine", {
      uLeftImage: this.textures.left,
      uRightImage: this.textures.right,
      uTrustAtEnds: softens ? Renderer.TRUST_AT_ENDS : 1,
      ...warped,
    }]];
    if (this.scene.holes !== "none") {
      passes.push(["fill", {uMirror: this.scene.holes === "mirror", uFillsMixedPixels: softens}]);
    }
    if (this.scene.holes === "interpolate") {
      passes.push(["interpolate", {}]);
    }
    if (softens) {
      passes.push([y === 0 ? "soften" : "outlines", warped]);
    }
    if (this.scene.holes !== "none") {
      passes.push(["rows", {}]);
    }
    // From one target to the other and back; the last pass ends in the view.
    let from = null;
    passes.forEach(([name, values], index) => {
      const to = index === passes.length - 1 ? this.view : this.steps[index % 2];
      this.pass(this.programs[name], to,
                {uColour: from?.colour, uDisparity: from?.disparity, ...values});
      from = to;
    });
    gl.bindTexture(gl.TEXTURE_2D, this.view.colour);
    gl.generateMipmap(gl.TEXTURE_2D);
  }

  warp(target, map, shift) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, ...this.targetSize);
    gl.clearBufferuiv(gl.COLOR, 0, [Renderer.UNKNOWN_BITS, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.enable(gl.DEPTH_TEST);
    this.use(this.programs.warp, {
      uMap: map, uShift: shift, uMargin: this.margin, uTargetSize: this.targetSize,
    });
    gl.drawArraysInstanced(gl.POINTS, 0, this.scene.width * this.scene.height,
                           shift[1] === 0 ? 1 : 2);
    gl.disable(gl.DEPTH_TEST);
  }

  pass(program, target, values) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, this.scene.width, this.scene.height);
    this.use(program, values);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // The nearer camera counts more, and both take the brightness of a camera in between.
  blending(shifts) {
    const [left, right] = shifts.map((shift) => Math.hypot(...shift));
    const alpha = right / (left + right);
    const gamma = this.scene.gamma ?? alpha;
    const {offset, gain} = this.frame.intensity;  // right = offset + gain * left, per channel
    return {
      uAlpha: alpha,
      uLeftScale: gain.map((b) => gamma + (1 - gamma) * b),
      uLeftOffset: offset.map((a) => (1 - gamma) * a),
      uRightScale: gain.map((b) => gamma / b + (1 - gamma)),
      uRightOffset: offset.map((a, c) => -gamma * a / gain[c]),
    };
  }

  clear(width, height) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  // Draws onto the canvas, into the box [x, y, width, height] from the lower left. what: "view",
  // "disparity", "left" or "right".
  show(what, box) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(...box);
    this.use(this.programs.show, this.shown(what));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // Draws the view as a screen in space into a box of the current framebuffer; values: those of
  // headset.vert.
  showOnScreen(box, values) {
    const gl = this.gl;
    gl.viewport(...box);
    this.use(this.programs.headset, {...this.shown("view"), ...values});
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  // The values of show.frag.
  shown(what) {
    return {
      uPicture: what === "left" || what === "right" ? this.textures[what] : this.view.colour,
      uDisparity: this.view.disparity,
      uPalette: this.textures.palette,
      uPaletteRange: this.scene.paletteRange,
      uShowsDisparities: what === "disparity",
    };
  }

  // Draws the left photograph's pixels as points, seen from the place of an Orbit.
  showCloud(orbit, width, height) {
    const gl = this.gl;
    const {focal, centre, doffs, pivotDisparity} = this.scene.cloud;
    const depth = focal / (pivotDisparity + doffs);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.use(this.programs.cloud, {
      uMap: this.textures.leftMap,
      uPicture: this.textures.left,
      uRotation: orbit.rotation(),
      uPivot: [0, 0, depth],
      uEye: [orbit.shift[0] * depth, orbit.shift[1] * depth, -orbit.distance * depth],
      uFocal: focal,
      uCentre: centre,
      uDoffs: doffs,
      uFarthest: Renderer.FARTHEST_IN_CLOUD * depth,
      uCanvas: [width, height],
      uScale: Math.min(width / this.scene.width, height / this.scene.height),
    });
    gl.drawArrays(gl.POINTS, 0, this.scene.width * this.scene.height);
    gl.disable(gl.DEPTH_TEST);
  }

  // The pixels of the last view, RGB, row by row from the top.
  pixels() {
    const gl = this.gl;
    const {width, height} = this.scene;
    const rgba = new Uint8Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.view.framebuffer);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    const rgb = new Uint8Array(3 * width * height);
    for (let from = 0, to = 0; from < rgba.length; from += 4) {
      rgb[to++] = rgba[from];
      rgb[to++] = rgba[from + 1];
      rgb[to++] = rgba[from + 2];
    }
    return rgb;
  }
}

// Of a pixel at the end of its surface: how much it counts beside one whose surface goes on.
Renderer.TRUST_AT_ENDS = 0.1;

// In depths of the pivot, the median: disparities near 0 would be anywhere.
Renderer.FARTHEST_IN_CLOUD = 30;

// Of disparity.glsl's UNKNOWN.
Renderer.UNKNOWN_BITS = new Uint32Array(new Float32Array([1.0e30]).buffer)[0];
