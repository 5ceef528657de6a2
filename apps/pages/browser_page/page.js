"use strict";

// The page: files and options go to the worker, its results become a map, remarks and views.
// <html data-status> says how far it is: "ready" before the first pair, "working", "matched" when
// the map is shown, "shown" when the views are there too, "failed".

(() => {
  const element = (id) => document.getElementById(id);
  const root = document.documentElement;
  const EXAMPLE_SIZE = [480, 360];
  const state = {
    files: {left: null, right: null},
    worker: null, isBusy: false, number: 0,          // of the last task
    name: "", notes: [], result: null, page: "",     // of the pair that is shown
    place: [0, 0],                                   // whose value is shown
  };

  function fail(text) {
    element("error").textContent = text;
    element("error").hidden = false;
    element("status").textContent = "";
    root.dataset.status = "failed";
  }

  function begin(text) {
    element("error").hidden = true;
    element("status").textContent = text;
    root.dataset.status = "working";
  }

  // -- The worker

  function startWorker() {
    const text = [element("engine").textContent, element("worker").textContent];
    const address = URL.createObjectURL(new Blob(text, {type: "text/javascript"}));
    state.worker = new Worker(address);
    URL.revokeObjectURL(address);
    state.worker.onmessage = ({data}) => {
      if (data.number === state.number) {
        receive(data);
      }
    };
    state.worker.onerror = (event) => fail(`The matcher does not run here: ${event.message}`);
  }

  // What is asked before the last answer is there takes the place of what was asked before.
  function ask(task) {
    if (state.isBusy) {
      state.worker.terminate();
      startWorker();
    }
    state.isBusy = true;
    state.number += 1;
    state.worker.postMessage({number: state.number, ...task});
  }

  function receive(data) {
    if (data.error) {
      state.isBusy = false;
      fail(data.error);
    } else if (data.left) {
      state.isBusy = false;
      match(data, "example", ["an artificial scene"]);
    } else if (data.page) {
      state.isBusy = false;
      state.page = data.page;
      element("view").srcdoc = data.page;
    } else {
      showMap(data);
    }
  }

  // -- Tasks

  function match({left, right}, name, notes) {
    state.name = name;
    state.notes = notes;
    begin(`Matching ${left.width}×${left.height} pixels …`);
    const options = [`preset=${element("preset").value}`, "threads=1",
                     `disparities=${element("disparities").value.trim() || "auto"}`];
    ask({left, right, options, names: name});
  }

  async function matchFiles() {
    const {left, right} = state.files;
    if (!left) {
      fail(right ? "Choose the left picture, too" : "Choose pictures first");
      return;
    }
    begin("Reading …");
    try {
      const pictures = await Pictures.prepare(right ? [left, right] : [left], {
        packing: element("packing").value,
        isExchanged: element("exchanged").checked,
        megapixels: Number(element("size").value),
      });
      match(pictures, right ? `${left.name} and ${right.name}` : left.name, pictures.notes);
    } catch (error) {
      if (!(error instanceof PictureError)) {
        throw error;
      }
      fail(error.message);
    }
  }

  // One file is both eyes; of two, the names tell which is the left one, as in left.png, right.png
  // or im0.png, im1.png.
  function drop(files) {
    if (files.length > 2) {
      fail("Drop one or two files");
      return;
    }
    const [left, right = null] = [...files].sort((a, b) => a.name.localeCompare(b.name));
    state.files = {left, right};
    for (const side of ["left", "right"]) {
      const list = new DataTransfer();
      if (state.files[side]) {
        list.items.add(state.files[side]);
      }
      element(side).files = list.files;
    }
    matchFiles();
  }

  // -- Results

  function showMap(result) {
    state.result = result;
    const {colours, range, remarks, milliseconds} = result;
    const canvas = element("map");
    element("results").hidden = false;
    [canvas.width, canvas.height] = [colours.width, colours.height];
    canvas.getContext("2d").putImageData(colours, 0, 0);
    element("farthest").textContent = `${range[0].toFixed(1)} px, far`;
    element("nearest").textContent = `near, ${range[1].toFixed(1)} px`;
    const items = [...state.notes.map((text) => ({text})), ...remarks,
                   {text: "pictures are matched with 8 bits; without OpenCV, black borders are " +
                          "not looked for"}];
    element("remarks").replaceChildren(...items.map(({text, isWarning}) => {
      const item = document.createElement("li");
      item.textContent = text;
      item.className = isWarning ? "warning" : "";
      return item;
    }));
    element("remarks").hidden = false;
    element("status").textContent =
      `${colours.width}×${colours.height} pixels matched in ${(milliseconds / 1000).toFixed(2)} s`;
    state.place = [colours.width >> 1, colours.height >> 1];
    showValue();
    layOut();
    root.dataset.status = "matched";
  }

  function showValue() {
    const {map, colours: {width}} = state.result;
    const [x, y] = state.place;
    const at = y * width + x;
    element("value").textContent = `(${x}, ${y}): ` +
      (Number.isFinite(map[at]) ? `${map[at].toFixed(2)} px` : "unknown");
  }

  function moveTo(x, y) {
    const {width, height} = element("map");
    const within = (value, size) => Math.min(Math.max(Math.floor(value), 0), size - 1);
    state.place = [within(x, width), within(y, height)];
    showValue();
  }

  function listenToMap() {
    const canvas = element("map");
    canvas.addEventListener("pointermove", (event) => {
      const place = canvas.getBoundingClientRect();
      moveTo((event.clientX - place.left) / place.width * canvas.width,
             (event.clientY - place.top) / place.height * canvas.height);
    });
    const steps = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    canvas.addEventListener("keydown", (event) => {
      if (steps[event.key]) {
        event.preventDefault();
        const pixels = event.shiftKey ? 10 : 1;
        moveTo(...state.place.map((value, axis) => value + pixels * steps[event.key][axis]));
      }
    });
  }

  // The views are as large as the map beside them, with room for their controls below.
  function layOut() {
    const {clientWidth, clientHeight} = element("map");
    const controls_px = clientWidth < 460 ? 220 : 90;
    element("view").style.height = `${clientHeight + controls_px}px`;
  }

  // -- Files to keep

  function save(blob, ending) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${state.name.replace(/\.[a-z]+\b/gi, "").replaceAll(" ", "-")}${ending}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href));
  }

  function listenToSaves() {
    element("save-map").addEventListener("click", () => {
      const {map, colours} = state.result;
      save(Pictures.pfm(map, colours.width, colours.height), "-disparity.pfm");
    });
    element("save-colours").addEventListener("click", () =>
      element("map").toBlob((blob) => save(blob, "-disparity.png")));
    element("save-view").addEventListener("click", () =>
      save(new Blob([state.page], {type: "text/html"}), "-views.html"));
  }

  function listenToFiles() {
    for (const side of ["left", "right"]) {
      element(side).addEventListener("change", () => {
        state.files[side] = element(side).files[0] ?? null;
      });
    }
    document.addEventListener("dragover", (event) => {
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    document.addEventListener("dragleave", () => document.body.classList.remove("dropping"));
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      if (event.dataTransfer.files.length > 0) {
        drop(event.dataTransfer.files);
      }
    });
  }

  function start() {
    startWorker();
    listenToFiles();
    listenToMap();
    listenToSaves();
    element("form").addEventListener("submit", (event) => {
      event.preventDefault();
      matchFiles();
    });
    element("example").addEventListener("click", () => {
      begin("Rendering an example …");
      ask({example: EXAMPLE_SIZE});
    });
    // It begins to move by itself, unless people asked for less of that.
    element("view").addEventListener("load", () => {
      const sway = element("view").contentDocument?.getElementById("sway");
      if (sway && root.dataset.status === "matched") {
        if (!matchMedia("(prefers-reduced-motion: reduce)").matches) {
          sway.click();
        }
        root.dataset.status = "shown";
      }
    });
    new ResizeObserver(layOut).observe(element("map"));
    root.dataset.status = "ready";
  }

  start();
})();
