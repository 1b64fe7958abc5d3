/** A matrix of users by subcarriers on a canvas: holes hatched, zoomed and scrolled within its own frame, read by keys. */

import { cividis } from "./colours.js";
import { element, onWidth } from "./dom.js";
import { say } from "./words.js";

const LABELS = 68;
const AXIS = 20;
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

function canvasOf(width, height) {
  const scale = Math.min(2, window.devicePixelRatio || 1);
  const canvas = element("canvas", { width: Math.round(width * scale), height: Math.round(height * scale) });
  canvas.style.width = `${width}px`;
  canvas.style.height = `${height}px`;
  const pen = canvas.getContext("2d");
  pen.scale(scale, scale);
  pen.font = `11px ${getComputedStyle(document.body).fontFamily}`;
  pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--soft");
  pen.textBaseline = "middle";
  return [canvas, pen];
}

/** Which labels to write, so that they do not run into each other: every one, every second, every fifth … */
function stride(size, least) {
  return [1, 2, 5, 10, 20, 50, 100, 200].find((step) => step * size >= least) ?? 500;
}

function hatch(pen, x, y, width, height, ink) {
  pen.save();
  pen.beginPath();
  pen.rect(x, y, width, height);
  pen.clip();
  pen.strokeStyle = ink;
  pen.lineWidth = 1.6;
  pen.beginPath();
  for (let at = x - height; at < x + width; at += 5) {
    pen.moveTo(at, y + height);
    pen.lineTo(at + height, y);
  }
  pen.stroke();
  pen.restore();
}

function drawn({ values, range: [low, high] }, cell, tall) {
  const [canvas, pen] = canvasOf(cell * values[0].length, tall * values.length);
  const hole = getComputedStyle(document.documentElement).getPropertyValue("--hole");
  const gap = cell >= 8 ? 1.5 : cell >= 4 ? 0.5 : 0;
  const rise = tall >= 8 ? 1.5 : 0;
  values.forEach((row, user) => row.forEach((value, place) => {
    const [x, y, width, height] = [place * cell, user * tall, cell - gap, tall - rise];
    if (value === null) {
      if (cell >= 6 && tall >= 6) return hatch(pen, x, y, width, height, hole);
      pen.fillStyle = hole;
    } else pen.fillStyle = cividis(high > low ? (value - low) / (high - low) : 1);
    pen.fillRect(x, y, width, height);
  }));
  return canvas;
}

function columnLabels(count, cell) {
  const [canvas, pen] = canvasOf(cell * count, AXIS);
  const step = stride(cell, 28);
  pen.textAlign = "center";
  for (let place = 0; place < count; place += 1) {
    if (place && (place + 1) % step) continue;
    if (!place && step > 1 && cell * (step - 1) < 24) continue;
    const x = Math.max(pen.measureText(String(place + 1)).width / 2, (place + 0.5) * cell);
    pen.fillText(String(place + 1), Math.min(x, cell * count - 10), AXIS / 2);
  }
  return canvas;
}

function rowLabels(names, tall) {
  const [canvas, pen] = canvasOf(LABELS, tall * names.length);
  const step = stride(tall, 13);
  pen.textAlign = "right";
  names.forEach((name, user) => {
    if (step === 1 || !user || !((user + 1) % step)) {
      const y = Math.max(6, (user + 0.5) * tall);
      pen.fillText(name.length > 11 ? `${name.slice(0, 10)}…` : name, LABELS - 8, y);
    }
  });
  return canvas;
}

function colourBar(text) {
  const [canvas, pen] = canvasOf(120, 8);
  for (let at = 0; at < 120; at += 1) {
    pen.fillStyle = cividis(at / 119);
    pen.fillRect(at, 0, 1.5, 8);
  }
  canvas.setAttribute("aria-hidden", "true");
  return [canvas, text];
}

/**
 * A matrix view in an empty place; `show` draws another matrix and keeps zoom and place.
 * @param {HTMLElement} root
 * @returns {{show: (matrix: Matrix) => void}}
 */
export function matrixView(root) {
  let matrix = null;
  let zoom = 1;
  let at = [0, 0];
  const frame = element("div", { class: "matrix", tabindex: "0", role: "application", "aria-roledescription": say("console.matrix") });
  const mark = element("div", { class: "mark", hidden: true });
  const legend = element("span", { class: "legend" });
  const reading = element("output", { class: "reading", "aria-live": "polite" });
  const closer = element("button", { type: "button", class: "icon", click: () => zoomed(1) }, "+");
  const wider = element("button", { type: "button", class: "icon", click: () => zoomed(-1) }, "−");
  root.replaceChildren(frame, element("div", { class: "under" }, legend, reading, element("span", { class: "zoom" }, wider, closer)));
  const redraw = onWidth(root, draw);

  function size(width) {
    const fit = (width - LABELS) / matrix.values[0].length;
    const cell = Math.max(1, fit) * zoom;
    const tall = Math.min(TALLEST, Math.max(3, HEIGHT / matrix.values.length) * zoom);
    return [cell, tall];
  }

  function draw(width) {
    if (!matrix) return;
    const [cell, tall] = size(width);
    const picture = drawn(matrix, cell, tall);
    picture.addEventListener("pointermove", (event) => point(Math.floor(event.offsetY / tall), Math.floor(event.offsetX / cell)));
    const cells = element("div", { class: "cells" }, picture, mark);
    frame.replaceChildren(element("span"), columnLabels(matrix.values[0].length, cell), rowLabels(matrix.names, tall), cells);
    frame.firstChild.className = "corner";
    legend.replaceChildren(...colourBar(matrix.scale));
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
    const [cell, tall] = size(root.clientWidth);
    mark.hidden = false;
    Object.assign(mark.style, { left: `${at[1] * cell}px`, top: `${at[0] * tall}px`, width: `${cell}px`, height: `${tall}px` });
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
