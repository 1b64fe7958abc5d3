/** Elements made by script: one function for HTML and one for SVG, so that no text is ever parsed as markup. */

const SVG = "http://www.w3.org/2000/svg";

const shown = (children) => children.flat(2).filter((child) => child !== null && child !== undefined && child !== false && child !== "");

function made(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") node.addEventListener(name, value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...shown(children));
  return node;
}

/**
 * An HTML element. Attributes that hold a function are listeners; null and false leave an attribute or a child out.
 * @param {string} name
 * @param {Object<string, unknown>} [attributes]
 * @param {...(Node|string|null|Array<Node|string|null>)} children
 */
export function element(name, attributes = {}, ...children) {
  return made(document.createElement(name), attributes, children);
}

/** An SVG element, as {@link element}. */
export function shape(name, attributes = {}, ...children) {
  return made(document.createElementNS(SVG, name), attributes, children);
}

/** A picture in SVG with what it says to those who do not see it. */
export const drawing = (width, height, label, ...children) =>
  shape("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label }, ...children);

/** The element of the page with this id. */
export const byId = (id) => document.getElementById(id);

/** Fill a place anew. */
export const fill = (place, ...children) => place.replaceChildren(...shown(children));

/** Fill a place anew, but only where what it shows has changed: focus and opened details stay. */
export function fillIfNew(place, shown, make) {
  const key = JSON.stringify(shown);
  if (place.dataset.shown === key) return;
  place.dataset.shown = key;
  fill(place, make());
}

/** A button that does something. */
export const button = (click, attributes, ...children) => element("button", { type: "button", click, ...attributes }, ...children);

/** A row of a table with its heading; a cell is what stands in it, or the cell itself. */
export const row = (label, ...cells) =>
  element("tr", {}, element("th", { scope: "row" }, label), cells.map((cell) => (cell instanceof Node ? cell : element("td", {}, cell))));

/** A table of such rows, as cards hold them. */
export const rowsTable = (...rows) => element("table", { class: "rows" }, element("tbody", {}, ...rows));

/** A heading and value list from pairs. */
export function facts(pairs) {
  return element("dl", { class: "facts" }, pairs.map(([label, value]) => [element("dt", {}, label), element("dd", {}, value)]));
}

/** A frame that scrolls sideways within itself, for the keyboard too. */
export const scroller = (label, ...children) =>
  element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": label }, ...children);

/** A table with its caption, as answers hold them; `here` is the place of a row that stands out. */
export function table({ title, columns, rows, here = -1 }) {
  const line = (cells, cell, row = -1) => element("tr", { class: row >= 0 && row === here ? "here" : null }, cells.map((text, place) =>
    cell === "td" && place ? element("td", {}, String(text))
      : element("th", { scope: cell === "th" ? "col" : "row" }, String(text))));
  return scroller(title,
    element("table", {},
      element("caption", {}, title),
      element("thead", {}, line(columns, "th")),
      element("tbody", {}, rows.map((row, place) => line(row, "td", place)))));
}

/** In the place of what is not there yet. */
export const nothing = (text) => element("p", { class: "empty" }, text);

/** A picture as wide as its place, drawn anew with each width; it scrolls where it cannot be narrower. */
export function chart(label, draw) {
  const frame = scroller(label);
  onWidth(frame, (width) => frame.replaceChildren(draw(width)));
  return frame;
}

/**
 * Draw something as wide as its place, now and whenever the width changes.
 * @param {HTMLElement} root
 * @param {(width: number) => void} draw
 */
export function onWidth(root, draw) {
  let last = 0;
  const measured = () => {
    const width = Math.floor(root.clientWidth);
    if (width > 0 && width !== last) {
      last = width;
      draw(width);
    }
  };
  new ResizeObserver(measured).observe(root);
  return () => {
    last = 0;
    measured();
  };
}
