"use strict";

// The page: where the viewer is, what is shown, and who may say so.
//
// A position (x, y) is in baselines: x = 0 is the left camera, x = 1 the right one, y > 0 below them.
// It comes from the mouse or a finger, the sliders, the keys, the tilt of a phone, or from outside:
//
//   page.contentWindow.postMessage({viewX: 0.4, viewY: 0.1}, "*");
//
// is all that a head tracker in a surrounding page has to do; either number may be left out.
//
// The address may say what is shown, "page.html#x=0.5,y=0,mode=disparity" (or with ? and &):
//   x, y     the position; the view then stands still until somebody moves it with the mouse
//   mode     a value of the list of modes
//   yaw, pitch, zoom   of the point cloud: degrees to the right and upwards, and how much nearer
//   eyes     distance of the eyes in baselines, for the modes of two views
//   sway=1   sways from the start;  bare=1  hides the controls
//   render=native  renders a view for every x that is given, with the y of the same number or the
//     last, in the photographs' own size, and puts its pixels into the document: one
//     <pre class="pixels"> each, RGB bytes row by row from the top, as base64. For other programs.
// When the first view is drawn, <html data-status> becomes "ready"; "failed" if that cannot be.

(() => {
  const element = (id) => document.getElementById(id);
  const scene = JSON.parse(element("scene").textContent);
  const canvas = element("canvas");
  const clamp = (value, [low, high]) => Math.min(Math.max(value, low), high);
  const isStereo = (mode) => ["parallel", "crossed", "anaglyph"].includes(mode);

  const SMOOTHING_SECONDS = 0.06;  // hides the steps of a mouse or a tracker
  const SWAY_SECONDS = 5;          // there and back
  const SWAY_DEGREES = 20;         // of the point cloud, to each side
  const KEY_DEGREES = 5;
  const TRACKER_HOLDS_MS = 1000;   // a mouse that lies on the desk must not fight a head tracker
  const TILT_DEGREES = 25;         // of a phone, from the middle to the end of the range

  const middle = ([low, high]) => (low + high) / 2;
  const state = {
    x: middle(scene.rangeX), y: clamp(0, scene.rangeY),                // what is drawn
    targetX: middle(scene.rangeX), targetY: clamp(0, scene.rangeY),    // where it is going
    mode: "view", eyes: 0.5,
    held: false, swaying: false, swayStart: 0, trackedAt: -Infinity,
    tiltOrigin: null, lastTime: 0, scheduled: false,
  };
  let renderer = null;
  const orbit = new Orbit(canvas, () => state.mode === "cloud", () => schedule());

  function fail(text) {
    element("message").textContent = text;
    element("message").hidden = false;
    document.documentElement.dataset.status = "failed";
  }

  function makeRenderer() {
    const gl = canvas.getContext("webgl2", {alpha: false, antialias: false});
    if (!gl) {
      fail("This page draws with WebGL 2, which this browser does not have or has switched off. " +
           "Any current browser has it; look for hardware or graphics acceleration in the settings.");
      return;
    }
    const pictures = {left: element("left-image"), right: element("right-image"),
                      leftMap: element("left-map"), rightMap: element("right-map"),
                      palette: element("palette")};
    for (const [name, picture] of Object.entries(pictures)) {
      if (!picture.complete || picture.naturalWidth === 0) {
        fail(`The picture "${name}" of this file is damaged.`);
        return;
      }
    }
    const shared = element("disparity.glsl").textContent;
    const head = "#version 300 es\nprecision highp float;\nprecision highp int;\n" +
                 "precision highp sampler2D;\n";
    try {
      renderer = new Renderer(gl, scene, pictures,
                              (name) => head + shared + element(name).textContent);
    } catch (error) {
      if (!(error instanceof RendererError)) {
        throw error;
      }
      renderer = null;
      fail(error.message);
    }
  }

  // -- Drawing

  function schedule() {
    if (renderer && !state.scheduled) {
      state.scheduled = true;
      requestAnimationFrame(drawNext);
    }
  }

  function drawNext(time) {
    state.scheduled = false;
    if (state.swaying) {
      const phase = 2 * Math.PI * (time - state.swayStart) / 1000 / SWAY_SECONDS;
      // Between the cameras, where the view is best, however far the range goes.
      const low = Math.max(scene.rangeX[0], 0);
      const high = Math.min(scene.rangeX[1], 1);
      const [from, to] = low < high ? [low, high] : scene.rangeX;
      state.targetX = clamp((from + to) / 2 + (to - from) / 2 * Math.sin(phase), scene.rangeX);
      if (state.mode === "cloud") {
        orbit.yaw = SWAY_DEGREES * Math.sin(phase);
      }
    }
    const seconds = Math.min((time - state.lastTime) / 1000, 0.1);
    state.lastTime = time;
    const step = 1 - Math.exp(-seconds / SMOOTHING_SECONDS);
    let arrived = true;
    for (const [now, target] of [["x", "targetX"], ["y", "targetY"]]) {
      const rest = state[target] - state[now];
      const near = Math.abs(rest) < 0.0005;
      state[now] = near ? state[target] : state[now] + step * rest;
      arrived = arrived && near;
    }
    draw();
    if (!arrived || state.swaying) {
      schedule();
    }
  }

  // The largest box of that shape in the middle of a place of the canvas.
  function fit(width, height, [x, y, roomX, roomY]) {
    const scale = Math.min(roomX / width, roomY / height);
    const size = [Math.round(width * scale), Math.round(height * scale)];
    return [x + Math.floor((roomX - size[0]) / 2), y + Math.floor((roomY - size[1]) / 2), ...size];
  }

  // Columns of the left and the right eye's picture, half an eye distance from their middle. What is
  // in the middle of the disparities lies in the plane of the screen, nearer things before it: eyes
  // need not look crosswise at everything.
  function stereoColumns(half) {
    const shift = clamp(half * middle(scene.paletteRange), [-scene.width / 4, scene.width / 4]);
    const shown = scene.width - 2 * Math.abs(shift);
    return [[Math.abs(shift) + shift, shown], [Math.abs(shift) - shift, shown]];
  }

  function draw() {
    const pixels = window.devicePixelRatio || 1;
    const width = Math.max(Math.round(canvas.clientWidth * pixels), 1);
    const height = Math.max(Math.round(canvas.clientHeight * pixels), 1);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    let columns = [];
    if (isStereo(state.mode)) {
      // Both eyes stay within the range: at its end the pair stops, rather than flattens.
      const [low, high] = scene.rangeX;
      const half = Math.min(state.eyes, high - low) / 2;
      const centre = clamp(state.x, [low + half, high - half]);
      renderer.render(centre - half, state.y, 0);
      renderer.render(centre + half, state.y, 1);
      columns = stereoColumns(half);
    } else if (state.mode === "view" || state.mode === "disparity") {
      renderer.render(state.x, state.y);
    }
    renderer.clear(width, height);
    if (state.mode === "parallel" || state.mode === "crossed") {
      const half = Math.floor(width / 2);
      const sides = [[0, 0, half, height], [half, 0, half, height]]
        .map((side) => fit(columns[0][1], scene.height, side));
      const crossed = state.mode === "crossed";
      renderer.show("view", sides[crossed ? 1 : 0], columns[0]);
      renderer.show("rightView", sides[crossed ? 0 : 1], columns[1]);
    } else if (state.mode === "cloud") {
      renderer.showCloud(orbit, width, height);
    } else {
      const shape = [columns[0]?.[1] ?? scene.width, scene.height];
      renderer.show(state.mode, fit(...shape, [0, 0, width, height]), ...columns);
    }
    showPosition();
  }

  function showPosition() {
    for (const axis of ["x", "y"]) {
      element(axis).value = state[axis];
      element(`${axis}-value`).textContent = state[axis].toFixed(3);
    }
    element("eyes-value").textContent = state.eyes.toFixed(2);
  }

  // -- Moving

  function moveTo(x, y) {
    if (Number.isFinite(x)) {
      state.targetX = clamp(x, scene.rangeX);
    }
    if (Number.isFinite(y)) {
      state.targetY = clamp(y, scene.rangeY);
    }
    schedule();
  }

  function jumpTo(x, y) {
    moveTo(x, y);
    state.x = state.targetX;
    state.y = state.targetY;
  }

  function setSway(on) {
    state.swaying = on;
    state.swayStart = performance.now();
    element("sway").setAttribute("aria-pressed", on);
    schedule();
  }

  function setMode(mode) {
    state.mode = mode;
    element("mode").value = mode;
    element("eyes-group").hidden = !isStereo(mode);
    element("cloud-group").hidden = mode !== "cloud";
    canvas.classList.toggle("cloud", mode === "cloud");
    document.body.classList.toggle("in-cloud", mode === "cloud");
    schedule();
  }

  function hold(on) {
    state.held = on;
    canvas.classList.toggle("held", on);
  }

  function followPointer(event) {
    if (state.mode === "cloud" || state.swaying || (state.held && event.pointerType === "mouse")
        || performance.now() - state.trackedAt < TRACKER_HOLDS_MS) {
      return;
    }
    const place = canvas.getBoundingClientRect();
    const along = (position, [low, high]) => low + (high - low) * position;
    moveTo(along((event.clientX - place.left) / place.width, scene.rangeX),
           along((event.clientY - place.top) / place.height, scene.rangeY));
  }

  function listenToPointer() {
    canvas.addEventListener("pointermove", followPointer);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.focus();
      if (state.swaying) {
        setSway(false);
        hold(false);
      } else if (event.pointerType === "mouse" && state.mode !== "cloud") {
        hold(!state.held);
      }
      followPointer(event);
    });
  }

  function listenToControls() {
    for (const axis of ["x", "y"]) {
      element(axis).addEventListener("input", () => {
        const value = Number(element(axis).value);
        setSway(false);
        hold(true);
        jumpTo(axis === "x" ? value : undefined, axis === "y" ? value : undefined);
      });
    }
    element("eyes").addEventListener("input", () => {
      state.eyes = Number(element("eyes").value);
      schedule();
    });
    element("mode").addEventListener("change", () => setMode(element("mode").value));
    element("sway").addEventListener("click", () => setSway(!state.swaying));
    element("reset").addEventListener("click", () => orbit.reset());
    element("full").addEventListener("click", toggleFullScreen);
    element("hide").addEventListener("click", toggleControls);
  }

  function toggleFullScreen() {
    if (document.fullscreenElement) {
      document.exitFullscreen();
    } else {
      document.documentElement.requestFullscreen().catch(() => {});  // refused: stays as it is
    }
  }

  function toggleControls() {
    document.body.classList.toggle("bare");
  }

  function listenToKeys() {
    const modes = [...element("mode").options].map((option) => option.value);
    const stepX = (scene.rangeX[1] - scene.rangeX[0]) / 40;
    const stepY = (scene.rangeY[1] - scene.rangeY[0]) / 40;
    const move = (dx, dy) => {
      setSway(false);
      if (state.mode === "cloud") {
        orbit.turn(KEY_DEGREES * Math.sign(dx), -KEY_DEGREES * Math.sign(dy));
        return;
      }
      hold(true);
      moveTo(state.targetX + dx, state.targetY + dy);
    };
    const actions = {
      "ArrowLeft": () => move(-stepX, 0), "ArrowRight": () => move(stepX, 0),
      "ArrowUp": () => move(0, -stepY), "ArrowDown": () => move(0, stepY),
      "+": () => orbit.approach(0.9), "-": () => orbit.approach(1 / 0.9),
      "0": () => orbit.reset(), " ": () => setSway(!state.swaying), "h": toggleControls, "f": toggleFullScreen,
    };
    modes.forEach((mode, index) => {
      actions[String(index + 1)] = () => setMode(mode);
    });
    document.addEventListener("keydown", (event) => {
      const isControl = event.target.matches("input, select, button");
      const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (action && !isControl && !event.ctrlKey && !event.metaKey && !event.altKey) {
        event.preventDefault();
        action();
      }
    });
  }

  // Head trackers, see above. Numbers are all that is taken from a message, whoever sends it.
  function listenToMessages() {
    window.addEventListener("message", ({data}) => {
      const [x, y] = [data?.viewX, data?.viewY];
      if (Number.isFinite(x) || Number.isFinite(y)) {
        state.trackedAt = performance.now();
        setSway(false);
        moveTo(x, y);
      }
    });
  }

  function followTilt(event) {
    if (event.gamma === null || event.beta === null) {
      return;
    }
    // Through a window whose right edge is turned away one looks from the left. Whichever way the
    // screen is turned, "right" is the right of what it shows.
    const turn = (screen.orientation?.angle ?? 0) * Math.PI / 180;
    const right = -event.gamma * Math.cos(turn) - event.beta * Math.sin(turn);
    const down = event.gamma * Math.sin(turn) - event.beta * Math.cos(turn);
    state.tiltOrigin ??= {right, down};  // however the phone is held at first is the middle
    const along = (degrees, [low, high]) =>
      (low + high) / 2 + (high - low) / 2 * clamp(degrees / TILT_DEGREES, [-1, 1]);
    moveTo(along(right - state.tiltOrigin.right, scene.rangeX),
           along(down - state.tiltOrigin.down, scene.rangeY));
  }

  async function toggleTilt() {
    const on = element("tilt").getAttribute("aria-pressed") !== "true";
    if (on && DeviceOrientationEvent.requestPermission
        && await DeviceOrientationEvent.requestPermission().catch(() => "denied") !== "granted") {
      return;
    }
    state.tiltOrigin = null;
    element("tilt").setAttribute("aria-pressed", on);
    if (on) {
      setSway(false);
      window.addEventListener("deviceorientation", followTilt);
    } else {
      window.removeEventListener("deviceorientation", followTilt);
    }
  }

  function listenToTilt() {
    if (window.DeviceOrientationEvent && window.matchMedia("(pointer: coarse)").matches) {
      element("tilt").hidden = false;
      element("tilt").addEventListener("click", toggleTilt);
    }
  }

  // -- The address

  function addressed() {
    const hash = location.hash.slice(1).replaceAll(",", "&");
    return new URLSearchParams(hash || location.search);
  }

  function numbers(parameters, name) {
    return parameters.getAll(name).filter((text) => text !== "").map(Number)
      .filter(Number.isFinite);
  }

  function followAddress() {
    const parameters = addressed();
    const [x, y, eyes] = ["x", "y", "eyes"].map((name) => numbers(parameters, name)[0]);
    if (x !== undefined || y !== undefined) {
      hold(true);
      jumpTo(x, y);
    }
    const [yaw, pitch, zoom] = ["yaw", "pitch", "zoom"].map((name) => numbers(parameters, name)[0]);
    if (yaw !== undefined || pitch !== undefined || zoom > 0) {
      orbit.reset();
      orbit.turn(yaw ?? 0, pitch ?? 0);
      orbit.approach(zoom > 0 ? 1 / zoom : 1);
    }
    if (eyes !== undefined) {
      state.eyes = clamp(eyes, [0.05, 1]);
    }
    if ([...element("mode").options].some((option) => option.value === parameters.get("mode"))) {
      setMode(parameters.get("mode"));
    }
    document.body.classList.toggle("bare", parameters.get("bare") === "1");
    if (parameters.get("sway") === "1") {
      setSway(true);
    }
    schedule();
  }

  function base64(bytes) {
    let text = "";
    for (let begin = 0; begin < bytes.length; begin += 0x8000) {  // as many arguments as are safe
      text += String.fromCharCode(...bytes.subarray(begin, begin + 0x8000));
    }
    return btoa(text);
  }

  function deliverNativeViews(parameters) {
    const wantedY = numbers(parameters, "y");
    for (const [index, wantedX] of numbers(parameters, "x").entries()) {
      const x = clamp(wantedX, scene.rangeX);
      const y = clamp(wantedY[index] ?? wantedY.at(-1) ?? 0, scene.rangeY);
      renderer.render(x, y);
      const result = document.createElement("pre");
      result.className = "pixels";
      result.hidden = true;
      Object.assign(result.dataset, {x, y, width: scene.width, height: scene.height});
      result.textContent = base64(renderer.pixels());
      document.body.append(result);
    }
  }

  // -- Start

  function start() {
    for (const [axis, range] of [["x", scene.rangeX], ["y", scene.rangeY]]) {
      [element(axis).min, element(axis).max] = range;
      element(axis).disabled = range[0] === range[1];
    }
    element("y-group").hidden = scene.rangeY[0] === scene.rangeY[1];
    element("eyes").value = state.eyes;
    if (!scene.cloud.calibrated) {
      element("cloud-note").textContent += "; without a calibration depths are only roughly to scale";
    }
    setMode(state.mode);
    makeRenderer();
    if (!renderer) {
      return;
    }
    // The graphics of a laptop may be taken away while it sleeps, and come back.
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      renderer = null;
    });
    canvas.addEventListener("webglcontextrestored", () => {
      makeRenderer();
      schedule();
    });
    listenToPointer();
    listenToControls();
    listenToKeys();
    listenToMessages();
    listenToTilt();
    window.addEventListener("hashchange", followAddress);
    new ResizeObserver(schedule).observe(canvas);
    followAddress();
    const parameters = addressed();
    if (parameters.get("render") === "native") {
      deliverNativeViews(parameters);
    }
    draw();
    document.documentElement.dataset.status = "ready";
  }

  // Pictures are decoded by then.
  window.addEventListener("load", start);
})();
