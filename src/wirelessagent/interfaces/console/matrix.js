/**
 * A matrix of users by subcarriers: one pixel of a canvas for each entry, stretched by the page, so that it is sharp at
 * any width, on paper, and in both themes; holes are clear and show the hatching behind. Zoomed and scrolled within its
 * own frame, read by pointer and by keys.
 */

import { cividis } from "./colours.js";
import { button, element, onWidth } from "./dom.js";
import { say } from "./words.js";

const LABELS = 68;
const TALLEST = 22;
const HEIGHT = 300;
const ZOOMS = [1, 2, 4, 8];

/**
 * @typedef {object} Matrix
 * @property {string} label what is shown, for those who do not see it
 * @property {string[]} names of the rows
 * @property {Array<Array<number|null>>} values null where nothing is known
 * @property {[number, number]} range of the colours
 * @property {string} scale what the colours reach from and to
 * @property {(value: number|null, row: number, column: number) => string} read one entry in words
 */

/** A canvas of so many pixels, each of the colour of a share between 0 and 1; null is clear. */
function pixels(rows) {
  const canvas = element("canvas", { width: rows[0].length, height: rows.length });
  const pen = canvas.getContext("2d");
  rows.forEach((row, y) => row.forEach((share, x) => {
    if (share === null) return;
    pen.fillStyle = cividis(share);
    pen.fillRect(x, y, 1, 1);
  }));
  return canvas;
}

/** Labels at their places along an axis: every one, every second, every fifth … so that they do not run into each other. */
function labels(kind, texts, size, least) {
  const step = [1, 2, 5, 10, 20, 50, 100, 200].find((one) => one * size >= least) ?? 500;
  const written = texts.map((text, place) => [text, place])
    .filter(([, place]) => (place + 1) % step === 0 || (!place && size * (step - 1) >= least));
  const at = kind === "across" ? "left" : "top";
  return element("div", { class: kind, "aria-hidden": "true" }, written.map(([text, place]) => {
    const label = element("span", {}, text);
    label.style[at] = `clamp(6px, ${(100 * (place + 0.5)) / texts.length}%, 100% - 6px)`;
    return label;
  }));
}

/** A matrix view in an empty place; `show` draws another matrix and keeps zoom and place. */
export function matrixView(root) {
  let matrix = null;
  let zoom = 1;
  let at = [0, 0];
  const frame = element("div", { class: "matrix", tabindex: "0", role: "application", "aria-roledescription": say("console.matrix") });
  const mark = element("div", { class: "mark", hidden: true });
  const legend = element("span", { class: "legend" });
  const reading = element("output", { class: "reading", "aria-live": "polite" });
  const closer = button(() => zoomed(1), { class: "icon" }, "+");
  const wider = button(() => zoomed(-1), { class: "icon" }, "−");
  root.replaceChildren(frame, element("div", { class: "under" }, legend, reading, element("span", { class: "zoom" }, wider, closer)));
  const redraw = onWidth(root, draw);

  function size(width) {
    const [rows, columns] = [matrix.values.length, matrix.values[0].length];
    return [Math.max(1, (width - LABELS) / columns) * zoom, Math.min(TALLEST, Math.max(3, HEIGHT / rows) * zoom)];
  }

  function draw(width) {
    if (!matrix) return;
    const { values, names, range: [low, high] } = matrix;
    const [cell, tall] = size(width);
    const picture = pixels(values.map((row) => row.map((value) => (value === null ? null : high > low ? (value - low) / (high - low) : 1))));
    picture.addEventListener("pointermove", (event) => point(Math.floor(event.offsetY / tall), Math.floor(event.offsetX / cell)));
    const cells = element("div", { class: cell >= 6 && tall >= 6 ? "cells apart" : "cells" }, picture, mark);
    frame.replaceChildren(element("span", { class: "corner" }), labels("across", values[0].map((_, place) => String(place + 1)), cell, 28),
      labels("down", names.map((name) => (name.length > 11 ? `${name.slice(0, 10)}…` : name)), tall, 13), cells);
    const sizes = { cell: `${100 / values[0].length}%`, tall: `${tall}px`, high: `${tall * values.length}px`, times: (cell * values[0].length) / (width - LABELS) };
    for (const [name, value] of Object.entries(sizes)) frame.style.setProperty(`--${name}`, value);
    legend.replaceChildren(pixels([Array.from({ length: 60 }, (_, place) => place / 59)]), matrix.scale);
    mark.hidden = true;
    wider.disabled = zoom === ZOOMS[0];
    closer.disabled = zoom === ZOOMS.at(-1);
    root.querySelector(".zoom").hidden = zoom === 1 && cell >= 12 && tall >= 12;
  }

  function zoomed(direction) {
    zoom = ZOOMS[ZOOMS.indexOf(zoom) + direction] ?? zoom;
    redraw();
    const [cell, tall] = size(root.clientWidth);
    frame.scrollTo(at[1] * cell - root.clientWidth / 2, at[0] * tall - HEIGHT / 2);
  }

  function point(row, column) {
    const [rows, columns] = [matrix.values.length, matrix.values[0].length];
    at = [Math.max(0, Math.min(rows - 1, row)), Math.max(0, Math.min(columns - 1, column))];
    mark.hidden = false;
    Object.assign(mark.style, { left: `${(100 * at[1]) / columns}%`, top: `${(100 * at[0]) / rows}%`, width: `${100 / columns}%`, height: `${100 / rows}%` });
    reading.textContent = matrix.read(matrix.values[at[0]][at[1]], at[0], at[1]);
  }

  const moves = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
  frame.addEventListener("keydown", (event) => {
    const move = moves[event.key];
    if (!move || !matrix) return;
    event.preventDefault();
    point(at[0] + move[0], at[1] + move[1]);
    mark.scrollIntoView({ block: "nearest", inline: "nearest" });
  });

  return {
    show(next) {
      if (matrix && (matrix.values.length !== next.values.length || matrix.values[0].length !== next.values[0].length)) {
        zoom = 1;
        at = [0, 0];
      }
      matrix = next;
      frame.setAttribute("aria-label", next.label);
      closer.setAttribute("aria-label", say("console.zoom_in"));
      wider.setAttribute("aria-label", say("console.zoom_out"));
      reading.textContent = "";
      redraw();
    },
  };
}
