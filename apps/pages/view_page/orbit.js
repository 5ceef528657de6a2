"use strict";

// The camera of the point cloud: it orbits around a point of the scene. Drag turns it, the wheel and
// two fingers bring it nearer, the right or middle button (or Shift) moves what it turns around.

class Orbit {
  // changed(): called after every movement. isActive(): whether the pointer belongs to the cloud.
  constructor(canvas, isActive, changed) {
    this.canvas = canvas;
    this.isActive = isActive;
    this.changed = changed;
    this.pointers = new Map();  // those that are down: id => [x, y]
    this.reset();
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", (event) => this.roll(event), {passive: false});
    canvas.addEventListener("dblclick", () => this.isActive() && this.reset());
    canvas.addEventListener("contextmenu", (event) => this.isActive() && event.preventDefault());
  }

  // As the left camera sees it.
  reset() {
    this.yaw = 0;       // degrees, to the right
    this.pitch = 0;     // degrees, upwards
    this.distance = 1;  // from the pivot, in its depth
    this.shift = [0, 0];  // of the eye, right and down, in the pivot's depth
    this.changed();
  }

  turn(yaw, pitch) {
    this.yaw = (this.yaw + yaw + 540) % 360 - 180;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -89), 89);
    this.changed();
  }

  approach(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, 0.05), 20);
    this.changed();
  }

  press(event) {
    if (!this.isActive()) {
      return;
    }
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.canvas.setPointerCapture(event.pointerId);
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!this.isActive() || !before) {
      return;
    }
    const spread = () => {
      const [a, b] = [...this.pointers.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    const now = [event.clientX, event.clientY];
    if (this.pointers.size === 2) {
      const old = spread();
      this.pointers.set(event.pointerId, now);
      this.approach(old / Math.max(spread(), 1));
      return;
    }
    this.pointers.set(event.pointerId, now);
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    const size = Math.max(this.canvas.clientHeight, 1);
    if (event.buttons & 6 || event.shiftKey) {
      this.shift = [this.shift[0] - dx / size * this.distance,
                    this.shift[1] - dy / size * this.distance];
      this.changed();
    } else {
      this.turn(-180 * dx / size, 180 * dy / size);
    }
  }

  roll(event) {
    if (this.isActive()) {
      event.preventDefault();
      this.approach(Math.exp(Math.max(-100, Math.min(event.deltaY, 100)) * 0.0015));
    }
  }

  // Of the points around the pivot, column by column: yaw first.
  rotation() {
    const [yaw, pitch] = [this.yaw, this.pitch].map((degrees) => degrees * Math.PI / 180);
    const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
    return [cy, sp * sy, -cp * sy, 0, cp, sp, sy, -sp * cy, cp * cy];
  }
}
