"""What the demo found out: the lines it prints at its end, report.json and index.html."""

import html
import json

import disparity_picture as picture
from demo_page import facts, figure, frames, legend, page, player, table

BAD_KEYS = [("bad 0.5", "bad_0_5_percent"), ("bad 1", "bad_1_percent"),
            ("bad 2", "bad_2_percent"), ("bad 4", "bad_4_percent")]
SIZE_KEYS = [("average", "average_px"), ("RMS", "rms_px"), ("A50", "a50_px"), ("A90", "a90_px"),
             ("A95", "a95_px"), ("A99", "a99_px")]


def number(value, digits, unit=""):
    return "–" if value is None else f"{value:.{digits}f}{unit}"


def errors_table(rows):
    """One row per (name, results of `vantage eval`)."""
    head = ["", "coverage", *(name for name, _ in BAD_KEYS), *(name for name, _ in SIZE_KEYS)]
    return table(head, [
        [name, number(results["coverage_percent"], 1, " %"),
         *(number(results[key], 1, " %") for _, key in BAD_KEYS),
         *(number(results[key], 2, " px") for _, key in SIZE_KEYS)]
        for name, results in rows])


def times_table(steps):
    rows = []
    for name, step in steps.items():
        if name.startswith("eval-") and name != "eval-raw":
            continue  # one of the frames judged: its times tell nothing new
        report = step.report
        seconds = report["seconds"]
        stages = ", ".join(f"{stage} {value:.3f}" for stage, value in seconds["stages"].items())
        rows.append([
            step.title, number(step.seconds, 2, " s"), number(seconds["compute"], 3, " s"),
            number(report["cells_per_second"] / 1e6, 0) if report["cells"] else "–",
            number(report["peak_memory_bytes"] / 2**20, 0, " MiB"), stages])
    return table(["step", "whole run", "compute", "million cells/s", "peak memory",
                  "stages (s)"], rows)


def photographs_section(scene):
    return ("<h2>The pair</h2>"
            f'<p class="soft">{html.escape(scene.origin)}. The cameras stand side by side; near '
            "things are further to the left in the right image. That shift is the disparity.</p>"
            '<div class="grid">' + figure(scene.left, "Left image", "") +
            figure(scene.right, "Right image", "") + "</div>")


def views_section():
    return ("<h2>New views</h2><p class=\"soft\">Rendered from the two images and the two computed "
            "maps below. No camera stood at these places.</p><div class=\"grid\">" +
            figure("views/centre.png", "The view half-way", "between the two cameras") +
            figure("views/sweep.mp4", "A sweep",
                   "from the left camera to the right one in 73 views", "video",
                   "controls autoplay muted loop playsinline") + "</div>")


def method_text(settings):
    """How a pair was matched, by the settings of its report: what `auto` stood for."""
    resolved = settings["resolved"]
    return (f'Preset {resolved["preset"]}: cost {resolved["cost"]}, aggregation '
            f'{resolved["aggregate"]}, {resolved["levels"]} levels, disparities '
            f'{resolved["disparities"].replace(":", " to ")} px')


def maps_section(demo, scene, colours):
    low, high = colours
    return ("<h2>Disparity maps</h2>"
            f'<p class="soft">{method_text(demo.steps["match"].report["settings"])}. All maps share '
            "one scale of colours.</p>" +
            legend(picture.TURBO, f"{low:.0f} px", f"{high:.0f} px", "unknown") +
            '<div class="grid">' +
            figure("pictures/left.png", "Left map", '<a href="maps/left.pfm">left.pfm</a>') +
            figure("pictures/right.png", "Right map", '<a href="maps/right.pfm">right.pfm</a>') +
            figure("pictures/truth.png", "Truth of the left image",
                   f'<a href="{scene.truth}">{html.escape(scene.truth.split("/")[-1])}</a>') +
            figure("pictures/left-raw.png", "Left map, winner-take-all only",
                   "before the cross-check and the filling of what had no match") +
            figure("pictures/error.png", "Error of the left map",
                   "|left map − truth|, on the scale below") +
            figure("maps/unmatched.png", "No match",
                   "white where left and right map disagreed: filled from the background") +
            "</div>" + legend(picture.HEAT, "0 px", "8 px and more", "no truth") +
            "<h2>Errors against the truth</h2>"
            '<p class="soft">bad N: pixels that are off by more than N px, or have no value, among '
            "all whose truth is known, those hidden in the right image included. A90: 90 % of the "
            "pixels with a value are off by no more.</p>" +
            errors_table([("left map", demo.steps["eval"].report["results"]),
                          ("winner-take-all only", demo.steps["eval-raw"].report["results"])]))


def sequence_section(demo, judged_frames):
    run = demo.steps["run"].report
    results, seconds = run["results"], run["seconds"]
    count = results["frames"]
    rows = []
    for frame in judged_frames:
        map_scores = demo.steps[f"eval-{frame:06}"].report["results"]
        view_scores = demo.steps[f"eval-view-{frame:06}"].report["results"]
        rows.append([f"frame {frame + 1}",
                     *(number(map_scores[key], 1, " %") for _, key in BAD_KEYS),
                     number(map_scores["average_px"], 2, " px"),
                     number(view_scores["psnr_db"], 1, " dB"),
                     number(view_scores["mean_absolute_difference"], 2),
                     number(view_scores["ssim"], 4)])
    head = ["", *(f"map: {name}" for name, _ in BAD_KEYS), "map: average", "view: PSNR",
            "view: mean |difference|", "view: SSIM"]
    return ("<h2>A sequence</h2>"
            f'<p class="soft">{count} frames of {results["width_px"]}×{results["height_px"]} from '
            "<code>vantage generate scene</code>, through <code>vantage run</code> in "
            f"{seconds['wall']:.2f} s: {count / seconds['wall']:.1f} frames/s with reading and "
            f"writing, {count / seconds['compute']:.1f} frames/s of compute, "
            f"{results['in_flight']} frames in flight.</p>"
            '<div class="grid">' +
            frames("sequence/scene/left/{}.png", "Left image", "of the moving scene") +
            frames("sequence/results/preview/{}.png", "Left map", "by its preview") +
            frames("sequence/results/views/{}.png", "The view half-way", "synthesised") +
            frames("sequence/scene/views/{}.png", "The view half-way", "as the scene renders it")
            + "</div>" + player(count) + table(head, rows))


def how_section(demo):
    commands = "\n".join(html.escape(step.command) for step in demo.steps.values())
    links = ", ".join(f'<a href="reports/{name}.json">{name}</a>' for name in demo.steps)
    return (f"<h2>Times</h2>{times_table(demo.steps)}"
            '<h2>How this was made</h2><p class="soft">In the folder of this page:</p>'
            f"<pre>{commands}</pre>"
            f'<p class="soft">Reports: <a href="report.json">all in one</a>; {links}.</p>')


def write(demo, scene, colours, judged_frames):
    """Writes report.json and index.html and prints the findings."""
    document = {"scene": scene.name, "origin": scene.origin,
                "steps": {name: {"title": step.title, "command": step.command,
                                 "seconds": step.seconds, "report": step.report}
                          for name, step in demo.steps.items()}}
    with open(demo.out / "report.json", "w", encoding="utf-8") as file:
        json.dump(document, file, indent=2)
        file.write("\n")

    match = demo.steps["match"].report
    errors = demo.steps["eval"].report["results"]
    head = (f"<h1>Vantage: {html.escape(scene.name)}</h1>"
            '<p class="soft">Two images in, disparity maps and new views out, on this '
            f"machine: {match['threads']} threads, {html.escape(match['isa'])}, version "
            f"{html.escape(match['version'])}.</p>" +
            facts([("both maps, compute", number(match["seconds"]["compute"], 2, " s")),
                   ("million cells per second", number(match["cells_per_second"] / 1e6, 0)),
                   ("peak memory of match", number(match["peak_memory_bytes"] / 2**20, 0, " MiB")),
                   ("median error", number(errors["a50_px"], 2, " px")),
                   ("off by more than 2 px", number(errors["bad_2_percent"], 1, " %"))]))
    body = "\n".join([head, views_section(), photographs_section(scene),
                      maps_section(demo, scene, colours), sequence_section(demo, judged_frames),
                      how_section(demo)])
    (demo.out / "index.html").write_text(page(f"Vantage: {scene.name}", body), encoding="utf-8")

    print(f"== {scene.name}: off by more than 1 px {errors['bad_1_percent']:.1f} %, 2 px "
          f"{errors['bad_2_percent']:.1f} %, 4 px {errors['bad_4_percent']:.1f} %; mean error "
          f"{errors['average_px']:.2f} px, median {errors['a50_px']:.2f} px")
