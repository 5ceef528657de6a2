"use strict";

// The page: where the viewer is, what is shown, and who may say so.
//
// A position (x, y) is in baselines: x = 0 is the left camera, x = 1 the right one, y > 0 below them.
// It comes from the mouse or a finger, the sliders or the keys. In a film the space bar plays.
//
// The address may say what is shown, "page.html#x=0.5,y=0,mode=disparity" (or with ? and &):
//   x, y     the position; the view then stands still until somebody moves it with the mouse
//   mode     a value of the list of modes
//   frame    number of a frame of the film;  play=1  plays it
//   yaw, pitch, zoom   of the point cloud: degrees to the right and upwards, and how much nearer
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

  const SMOOTHING_SECONDS = 0.06;  // hides the steps of a mouse or a tracker
  const SWAY_SECONDS = 5;          // there and back
  const SWAY_DEGREES = 20;         // of the point cloud, to each side
  const KEY_DEGREES = 5;

  const middle = ([low, high]) => (low + high) / 2;
  const state = {
    x: middle(scene.rangeX), y: clamp(0, scene.rangeY),                // what is drawn
    targetX: middle(scene.rangeX), targetY: clamp(0, scene.rangeY),    // where it is going
    mode: "view", held: false, swaying: false, swayStart: 0, lastTime: 0, scheduled: false,
  };
  let renderer = null;
  const film = new Film(scene, showFrame);
  let headset = null;
  const orbit = new Orbit(canvas, () => state.mode === "cloud", () => schedule());

  function fail(text) {
    element("message").textContent = text;
    element("message").className = "";
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
    const shared = element("disparity.glsl").textContent;
    const head = "#version 300 es\nprecision highp float;\nprecision highp int;\n" +
                 "precision highp sampler2D;\n";
    try {
      renderer = new Renderer(gl, scene, element("palette"),
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
    if (renderer?.frame && !state.scheduled && !headset?.session) {
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
    film.advance(time);
    draw();
    if (!arrived || state.swaying || film.isPlaying) {
      schedule();
    }
  }

  // The largest box of the scene's shape in the middle of the canvas.
  function fit(width, height) {
    const scale = Math.min(width / scene.width, height / scene.height);
    const size = [Math.round(scene.width * scale), Math.round(scene.height * scale)];
    return [Math.floor((width - size[0]) / 2), Math.floor((height - size[1]) / 2), ...size];
  }

  function draw() {
    const pixels = window.devicePixelRatio || 1;
    const width = Math.max(Math.round(canvas.clientWidth * pixels), 1);
    const height = Math.max(Math.round(canvas.clientHeight * pixels), 1);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    if (state.mode === "view" || state.mode === "disparity") {
      renderer.render(state.x, state.y);
    }
    renderer.clear(width, height);
    if (state.mode === "cloud") {
      renderer.showCloud(orbit, width, height);
    } else {
      renderer.show(state.mode, fit(width, height));
    }
    showPosition();
  }

  function showPosition() {
    for (const axis of ["x", "y"]) {
      element(axis).value = state[axis];
      element(`${axis}-value`).textContent = state[axis].toFixed(3);
    }
  }

  // -- The film

  // A frame that is missing leaves the picture as it was, and says so.
  function showFrame(frame) {
    element("time").value = film.index;
    element("time-value").textContent = `${frame.number}`;
    element("message").className = "note";
    element("message").hidden = !frame.problem;
    element("message").textContent = `Frame ${frame.number}: ${frame.problem}`;
    if (frame.pictures) {
      renderer?.setFrame(frame);
    }
    schedule();
  }

  function setPlaying(on) {
    film.isPlaying = on;
    element("play").setAttribute("aria-pressed", on);
    element("play").textContent = on ? "Pause" : "Play";
    schedule();
  }

  function goBy(frames) {
    setPlaying(false);
    film.goTo(film.wanted + frames);
  }

  function listenToFilm() {
    element("film-group").hidden = film.frames.length === 1;
    element("time").max = film.frames.length - 1;
    element("time").addEventListener("input", () => {
      setPlaying(false);
      film.goTo(Number(element("time").value));
    });
    element("play").addEventListener("click", () => setPlaying(!film.isPlaying));
    element("back").addEventListener("click", () => goBy(-1));
    element("forth").addEventListener("click", () => goBy(1));
    element("speed").addEventListener("change", () => {
      film.speed = Number(element("speed").value);
    });
  }

  async function offerHeadset() {
    element("headset").hidden = !await Headset.isThere();
    element("headset").addEventListener("click", async () => {
      headset = new Headset(renderer, (time) => film.advance(time),
                            () => setPlaying(!film.isPlaying && film.frames.length > 1));
      try {
        await headset.enter(schedule);
      } catch (error) {
        element("headset").title = error.message;
        element("headset").disabled = true;
      }
    });
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
    if (state.mode === "cloud" || state.swaying
        || (state.held && event.pointerType === "mouse")) {
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
      "0": () => orbit.reset(), ",": () => goBy(-1), ".": () => goBy(1), "s": () => setSway(!state.swaying),
      " ": () => film.frames.length > 1 ? setPlaying(!film.isPlaying) : setSway(!state.swaying),
      "h": toggleControls, "f": toggleFullScreen,
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

  // -- The address

  function addressed() {
    const hash = location.hash.slice(1).replaceAll(",", "&");
    return new URLSearchParams(hash || location.search);
  }

  function numbers(parameters, name) {
    return parameters.getAll(name).filter((text) => text !== "").map(Number)
      .filter(Number.isFinite);
  }

  // Its index; -1: none is addressed.
  function addressedFrame() {
    const wanted = addressed().get("frame");
    return film.frames.findIndex(({number}) => String(number) === wanted);
  }

  function followAddress() {
    const parameters = addressed();
    const [x, y] = ["x", "y"].map((name) => numbers(parameters, name)[0]);
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
    if ([...element("mode").options].some((option) => option.value === parameters.get("mode"))) {
      setMode(parameters.get("mode"));
    }
    if (addressedFrame() >= 0) {
      film.goTo(addressedFrame());
    }
    if (parameters.get("play") === "1" && film.frames.length > 1) {
      setPlaying(true);
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

  async function start() {
    for (const [axis, range] of [["x", scene.rangeX], ["y", scene.rangeY]]) {
      [element(axis).min, element(axis).max] = range;
      element(axis).disabled = range[0] === range[1];
    }
    element("y-group").hidden = scene.rangeY[0] === scene.rangeY[1];
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
      showFrame(film.kept.get(film.index).frame);
    });
    listenToPointer();
    listenToControls();
    listenToKeys();
    listenToFilm();
    await film.goTo(film.frames.findIndex(({problem}) => !problem));
    if (!renderer.frame) {
      fail(element("message").textContent);
      return;
    }
    offerHeadset();
    await film.goTo(addressedFrame() < 0 ? film.index : addressedFrame());
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
