"use strict";

// The page in a headset (WebXR): a screen before the viewer, of which each eye is shown a view of its
// own, and the views follow the head. What is as far as the scene's middle lies in the screen. Eyes
// are as far apart as the cameras, or less where that would make the nearest and the farthest
// surface differ by more than is comfortable.

class Headset {
  // advance(time): called before each picture. toggle(): when the viewer presses a button.
  constructor(renderer, advance, toggle) {
    this.renderer = renderer;
    this.advance = advance;
    this.toggle = toggle;
    this.session = null;
  }

  static async isThere() {
    try {
      return await navigator.xr?.isSessionSupported("immersive-vr") ?? false;
    } catch {  // a policy of who embeds the page
      return false;
    }
  }

  // ended(): called when the viewer has left. Throws what the browser throws.
  async enter(ended) {
    const {gl} = this.renderer;
    const session = await navigator.xr.requestSession("immersive-vr");
    session.addEventListener("end", () => {
      this.session = null;
      ended();
    });
    session.addEventListener("select", this.toggle);
    await gl.makeXRCompatible();
    session.updateRenderState({baseLayer: new XRWebGLLayer(session, gl)});
    const space = await session.requestReferenceSpace("local");
    const draw = (time, frame) => {
      session.requestAnimationFrame(draw);
      this.advance(time);
      const pose = frame.getViewerPose(space);
      if (pose) {
        this.draw(pose.views, session.renderState.baseLayer);
      }
    };
    session.requestAnimationFrame(draw);
    this.session = session;
  }

  draw(eyes, layer) {
    const {gl, scene} = this.renderer;
    gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const middle = this.middle();
    for (const eye of eyes) {
      const {position, inverse} = eye.transform;
      const perMetre = this.eyeDistance() / Headset.EYES_M;
      const x = Headset.clamp(middle[0] + perMetre * position.x, scene.rangeX);
      const y = Headset.clamp(middle[1] - perMetre * position.y, scene.rangeY);
      this.renderer.render(x, y);
      const {x: left, y: low, width, height} = layer.getViewport(eye);
      gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
      const pivot = scene.cloud.pivotDisparity;
      this.renderer.showOnScreen([left, low, width, height], {
        uProjection: eye.projectionMatrix,
        uEye: inverse.matrix,
        uHalfSize: [this.halfWidth(), this.halfWidth() * scene.height / scene.width],
        uDistance: Headset.SCREEN_M,
        uMoved: [pivot * (x - middle[0]) / scene.width, pivot * (y - middle[1]) / scene.height],
      });
    }
  }

  // Of the page's range, in baselines.
  middle() {
    const {rangeX, rangeY} = this.renderer.scene;
    return [Headset.clamp(0.5, rangeX), Headset.clamp(0, rangeY)];
  }

  // As wide as the photograph's own angle, within what headsets show; in metres.
  halfWidth() {
    const {width, cloud} = this.renderer.scene;
    return Headset.SCREEN_M * Headset.clamp(width / 2 / cloud.focal, [0.35, 0.85]);
  }

  // In baselines, at most 1.
  eyeDistance() {
    const {width, cloud, paletteRange} = this.renderer.scene;
    const spread = Math.max(...paletteRange.map((d) => Math.abs(d - cloud.pivotDisparity)));
    const pixel = 2 * this.halfWidth() / Headset.SCREEN_M / width;
    return Math.min(1, Headset.COMFORTABLE / (pixel * spread));
  }

  static clamp(value, [low, high]) {
    return Math.min(Math.max(value, low), high);
  }
}

Headset.EYES_M = 0.063;
Headset.SCREEN_M = 2;
// One degree, as the tangent of an angle: beyond that from the screen, eyes tire.
Headset.COMFORTABLE = 0.0175;
