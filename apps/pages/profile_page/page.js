"use strict";

// The page: sections of what `vantage profile --json` keeps, which is in the element "profile". It
// says in words what the profile lacks.

(() => {
  const profile = JSON.parse(document.getElementById("profile").textContent);
  const count = profile.thread_counts.at(-1) ?? null;  // on the most threads
  const hasFrames = count?.frames_per_s.median > 0;

  function fillHeader() {
    document.getElementById("command").textContent = profile.command;
    const facts = {"processor": profile.processor,
                   "hardware threads": String(profile.hardware_threads),
                   "instruction set": profile.isa, "date": profile.date,
                   "Vantage": profile.version};
    document.getElementById("facts").append(
      ...Object.entries(facts).filter(([, value]) => value !== "").map(([name, value]) =>
        element("div", {}, element("dt", {}, name), element("dd", {}, value))));
  }

  function keyFigures() {
    const figures = [];
    const add = (name, value, detail) =>
      figures.push(element("div", {}, element("dt", {}, name), element("dd", {}, value),
                           element("dd", {class: "detail"}, detail)));
    if (count) {
      const wall = count.wall_s;
      add(`wall time on ${plural(count.threads, "thread")}`, quantityText(wall.median, "s"),
          `median of ${plural(count.runs, "run")}, ` +
          `${quantityText(wall.least, "s")} to ${quantityText(wall.most, "s")}`);
    }
    if (hasFrames) {
      const rate = count.frames_per_s;
      add("frames per second", numberText(rate.median),
          `${numberText(rate.least)} to ${numberText(rate.most)}`);
    } else if (count?.cells_per_s.median > 0) {
      const rate = count.cells_per_s;
      add("cells per second", quantityText(rate.median, ""),
          `${quantityText(rate.least, "")} to ${quantityText(rate.most, "")}`);
    }
    if (count?.workers.length > 0) {
      add("threads work", percentText(count.work_share.median), "of their time; else they wait");
    }
    if (profile.speed_ups.length > 1) {
      const [first, last] = [profile.speed_ups[0], profile.speed_ups.at(-1)];
      add(`speed-up, ${first.threads} to ${last.threads} threads`,
          numberText(last.ratio.median) + "×", "efficiency " + percentText(last.efficiency));
    }
    if (profile.serial_fraction !== null) {
      add("serial fraction", percentText(profile.serial_fraction), "of Amdahl's law as fitted");
    }
    if (profile.peak_memory_bytes > 0) {
      add("peak memory", quantityText(profile.peak_memory_bytes, "B"), "resident, of the process");
    }
    return figures.length > 0 ? element("dl", {class: "figures"}, ...figures)
                              : note("No run was measured.");
  }

  function stageSections() {
    if (!count?.stages.length) {
      return [section("Stages", note("No stage of matching ran, or none was recorded."))];
    }
    const rows = count.stages.map((stage) => [
      stage.name, sampleText(stage.seconds, "s"), bar(stage.work_share),
      knownText(stage.ns_per_cell),
      stage.cells > 0 ? quantityText(stage.cells_per_s, "") : UNKNOWN,
      stage.own_columns > 0 ? percentText(stage.halo_share) : UNKNOWN,
      knownText(stage.gb_per_s), knownText(stage.gflops),
      stage.roofline
        ? `${percentText(stage.roofline.roof_share)} ${stage.roofline.roof}` : UNKNOWN]);
    return [
      section("Stages",
              table([words("stage"), "time", words("share of work"), "ns/cell", "cells/s", "halo",
                     "GB/s", "GFLOP/s", "of its roof"], rows),
              note(`On ${plural(count.threads, "thread")}. Time is processor time: median and ` +
                   "range over the runs. Rates are those of one thread while it is in the stage. " +
                   "Halo: columns made in addition to the results. Bytes are those a stage loads " +
                   "and stores, whichever cache holds them.")),
      section("Roofline", ...roofline())];
  }

  function ceilingTable() {
    const several = profile.ceilings.filter((ceilings) => ceilings.threads > 1);
    const row = (name, key) =>
      [name, knownText(profile.ceilings[0][`core_${key}`]),
       ...several.map((ceilings) => knownText(ceilings[`all_${key}`]))];
    return table([words(""), "one thread", ...several.map(({threads}) => `all of ${threads}`)],
                 [row("arithmetic, GFLOP/s", "gflops"), row("level 2, GB/s", "l2_gb_per_s"),
                  row("memory, GB/s", "memory_gb_per_s")],
                 "What the machine can do, measured");
  }

  function roofline() {
    const ceilings = profile.ceilings.length > 0 ? [ceilingTable()] : [];
    if (!count.roofs) {
      return [note("There is no roofline: the machine's ceilings were not measured."), ...ceilings];
    }
    const drawn = count.stages.filter((stage) => stage.roofline);
    if (drawn.length === 0) {
      return [note("There is no roofline: no stage counts its operations and bytes."), ...ceilings];
    }
    const others = count.stages.filter((stage) => !stage.roofline).map((stage) => stage.name);
    const working = count.threads === 1 ? "one works" : `all ${count.threads} work`;
    return [sideBySide(
      [rooflineChart(drawn, count.roofs)],
      [note(`Roofs are the share of one thread while ${working}. A disc is a stage: its area is ` +
            "the time the stage takes, its colour the lower of the arithmetic (orange) and the " +
            "level-2 (blue) roof above it. A stage above the memory line has its data in caches."),
       ...(others.length > 0
         ? [note(`Not drawn, as they do not count their work: ${others.join(", ")}.`)] : []),
       ...ceilings])];
  }

  // Parts of the timeline, most time first. They and the first parts of the table have a colour
  // each, everywhere on the page; all others share one.
  const timelineParts = (() => {
    const seconds = new Map();
    for (const span of profile.timeline.flatMap((row) => row.spans)) {
      if (!span.is_wait) {
        seconds.set(span.name, (seconds.get(span.name) ?? 0) + span.end_s - span.begin_s);
      }
    }
    return [...seconds].sort(([, a], [, b]) => b - a).map(([name]) => name);
  })();
  const colouredParts =
    [...new Set([...timelineParts, ...(count?.parts ?? []).map((part) => part.name)])].slice(0, 7);
  const classOf = (name) =>
    colouredParts.includes(name) ? `part-${colouredParts.indexOf(name)}` : "part-more";

  function timeline() {
    if (profile.timeline.length === 0) {
      return [note("There is no timeline: no trace was recorded.")];
    }
    const coloured = timelineParts.filter((name) => colouredParts.includes(name));
    const hasOthers = coloured.length < timelineParts.length;
    return [
      legend(...coloured.map((name) => legendKey(classOf(name), name)),
             ...(hasOthers ? [legendKey("part-more", "other work")] : []),
             legendKey("wait", "waiting")),
      timelineChart(profile.timeline, profile.timeline_s, classOf),
      note("The run with the median wall time. Spans too short to be seen are joined." +
           (hasFrames ? " Every other frame is fainter; where there is room, the frame's number " +
                        "stands in the span." : ""))];
  }

  function timeByPart() {
    if (count.parts.length + count.waits.length === 0) {
      return [note("Where the threads' time went is not known: no trace was recorded.")];
    }
    const MIN_SHARE = 0.001;  // what takes less shares a row
    const rowsOf = (parts, suffix, classFor) => {
      const share = (part) => shareOf(part.seconds.median, count.pool_time_s);
      const isSmall = (part) => count.pool_time_s > 0 && share(part) < MIN_SHARE;
      const rows = parts.filter((part) => !isSmall(part)).map((part) => [
        legendKey(classFor(part.name), part.name + suffix), sampleText(part.seconds, "s"),
        bar(share(part)), countText(part.count)]);
      const small = parts.filter(isSmall);
      if (small.length > 0) {
        const sum = (get) => small.reduce((total, part) => total + get(part), 0);
        const seconds = sum((part) => part.seconds.median);
        const name = `${small.length} more, each below ${percentText(MIN_SHARE)}${suffix}`;
        rows.push([legendKey(classFor(null), name), quantityText(seconds, "s"),
                   bar(shareOf(seconds, count.pool_time_s)), countText(sum((part) => part.count))]);
      }
      return rows;
    };
    const remark =
      "The work of threads outside the pool is also shown as a share of the pool's time.";
    return [table([words("part"), "time", words("of the pool's time"), "spans"],
                  [...rowsOf(count.parts, "", classOf),
                   ...rowsOf(count.waits, " (waiting)", () => "wait")]),
            ...(count.workers.every((worker) => worker.is_in_pool) ? [] : [note(remark)])];
  }

  function useOfThreads() {
    if (count.workers.length === 0) {
      return [note("How much each thread worked is not known: no trace was recorded.")];
    }
    const rows = count.workers.map((worker) => worker.is_in_pool
      ? [worker.name, bar(shareOf(worker.work_s, worker.work_s + worker.wait_s)),
         quantityText(worker.work_s, "s"), quantityText(worker.wait_s, "s")]
      : [`${worker.name} (outside the pool)`, "", quantityText(worker.work_s, "s"), UNKNOWN]);
    return [table([words("thread"), words("works"), "work", "waits"], rows),
            paragraph("The busiest thread of the pool works " +
                      `${rangeText(count.imbalance)} times the mean.`)];
  }

  function waitingCauses() {
    const causes = {
      "images being read or decoded": count.waiting_for.reading_s,
      "tasks of other threads": count.waiting_for.computing_s,
      "results being encoded or written": count.waiting_for.writing_s,
      "nothing that was recorded: start, end, steps without tasks": count.waiting_for.nothing_s};
    if (!Object.values(causes).some((seconds) => seconds.median > 0)) {
      return [note("No waiting was recorded.")];
    }
    return [table([words("waited for"), "time", words("of the pool's time")],
                  Object.entries(causes).map(([name, seconds]) =>
                    [name, sampleText(seconds, "s"),
                     bar(shareOf(seconds.median, count.pool_time_s))])),
            note("A waiting thread is taken to wait for the threads that work at that moment.")];
  }

  function threadSections() {
    const first = section("Timeline", ...timeline());
    if (!count) {
      return [first];
    }
    const left = [section("Where the threads' time goes", ...timeByPart())];
    const right = [section("Use of threads", ...useOfThreads())];
    const isRightShorter = count.workers.length < count.parts.length + count.waits.length;
    (isRightShorter ? right : left).push(
      section("What waiting threads wait for", ...waitingCauses()));
    return [first, sideBySide(left, right)];
  }

  function scaling() {
    if (!count) {
      return [note("No run was measured.")];
    }
    const rows = profile.thread_counts.map((one) => {
      const speedUp = profile.speed_ups.find(({threads}) => threads === one.threads);
      return [String(one.threads), String(one.runs), sampleText(one.wall_s, "s"),
              sampleText(one.compute_s, "s"),
              hasFrames ? rangeText(one.frames_per_s) : sampleText(one.cells_per_s, ""),
              percentText(one.work_share.median),
              speedUp ? `${rangeText(speedUp.ratio)}×` : UNKNOWN, percentText(speedUp?.efficiency),
              percentText(speedUp?.serial_fraction)];
    });
    const all = table(["threads", "runs", "wall time", "compute",
                       hasFrames ? "frames/s" : "cells/s", "works", "speed-up", "efficiency",
                       "serial"], rows);
    if (profile.speed_ups.length < 2) {
      return [all, note("One number of threads was measured, so there is no speed-up.")];
    }
    const keys = [legendKey("measured", "measured, with range"), legendKey("ideal-field", "ideal")];
    if (profile.serial_fraction !== null) {
      const fraction = percentText(profile.serial_fraction);
      keys.push(legendKey("fitted-field", `Amdahl's law with a serial fraction of ${fraction}`));
    }
    return [sideBySide([speedUpChart(profile.speed_ups, profile.serial_fraction)],
                       [legend(...keys),
                        note("Speed-ups are ratios within a round of runs. Serial: the fraction " +
                             "of Karp and Flatt. Below 0, the speed-up is larger than the ratio " +
                             "of the numbers of threads.")]),
            all];
  }

  function memory() {
    const peak = profile.peak_memory_bytes;
    if (!(peak > 0)) {
      return [note("How much memory was used is not known.")];
    }
    const sum = paragraph(`At most ${quantityText(peak, "B")} were resident.`);
    if (profile.memory.length === 0) {
      return [sum, note("What used it is not known.")];
    }
    const owned = profile.memory.reduce((total, owner) => total + owner.bytes, 0);
    return [sum,
            table([words("owner"), "at its peak", words("of the process's peak")],
                  profile.memory.map(({name, bytes}) =>
                    [name, quantityText(bytes, "B"), bar(bytes / peak)])),
            ...(owned > peak
              ? [note("The sum of the owners is above the peak of the process, as they did not " +
                      "reach their peaks at the same time.")] : [])];
  }

  fillHeader();
  document.getElementById("main").append(
    keyFigures(),
    ...(profile.advice.length > 0
      ? [section("What you can do about the time", sentences(profile.advice))] : []),
    section("What holds it back",
            profile.findings.length > 0 ? sentences(profile.findings)
              : note("The figures are not enough to say what holds it back.")),
    ...stageSections(), ...threadSections(), section("Speed-up with threads", ...scaling()),
    section("Memory", ...memory()));
})();
