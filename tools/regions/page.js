"use strict";
const SVG = "http://www.w3.org/2000/svg";
const LEAST = 8;  // px, of a side
let regions = [], width = 1, height = 1;
const picture = document.getElementById("picture"), rows = document.getElementById("rows"), state = document.getElementById("state");

function say(text, kind) { state.textContent = text; state.dataset.kind = kind; }
function clamp(value, low, high) { return Math.min(Math.max(value, low), high); }

function limit(rect) {
  rect[2] = clamp(Math.round(rect[2]), LEAST, width);
  rect[3] = clamp(Math.round(rect[3]), LEAST, height);
  rect[0] = clamp(Math.round(rect[0]), 0, width - rect[2]);
  rect[1] = clamp(Math.round(rect[1]), 0, height - rect[3]);
}
// A side moves, the opposite one stays.
function moveSides(rect, du, dv, left, top) {
  const right = rect[0] + rect[2], bottom = rect[1] + rect[3];
  if (left) { rect[0] = clamp(rect[0] + du, 0, right - LEAST); rect[2] = right - rect[0]; }
  else rect[2] = clamp(rect[2] + du, LEAST, width - rect[0]);
  if (top) { rect[1] = clamp(rect[1] + dv, 0, bottom - LEAST); rect[3] = bottom - rect[1]; }
  else rect[3] = clamp(rect[3] + dv, LEAST, height - rect[1]);
}

function element(name, attributes, parent) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

function place(region) {
  const [u, v, w, h] = region.rect, radius = Math.max(width, height) / 110;
  for (const [key, value] of [["x", u], ["y", v], ["width", w], ["height", h]]) region.shape.setAttribute(key, value);
  region.shape.setAttribute("class", "region " + region.role);
  region.shape.setAttribute("aria-label", `${region.name}, ${region.role}, left ${u}, top ${v}, width ${w}, height ${h}`);
  region.label.setAttribute("x", u);
  region.label.setAttribute("y", v - radius / 2);
  region.label.textContent = region.name;
  region.corners.forEach((corner, i) => {
    corner.setAttribute("cx", i % 2 ? u + w : u);
    corner.setAttribute("cy", i > 1 ? v + h : v);
    corner.setAttribute("r", radius);
  });
  region.inputs.forEach((input, i) => { if (document.activeElement !== input) input.value = region.rect[i]; });
}

function follow(target, region, change) {
  target.addEventListener("pointerdown", (down) => {
    down.preventDefault();
    region.shape.focus();
    target.setPointerCapture(down.pointerId);
    const begin = [...region.rect], scale = 1 / picture.getScreenCTM().a;
    const move = (event) => {
      region.rect = [...begin];
      change(region.rect, (event.clientX - down.clientX) * scale, (event.clientY - down.clientY) * scale);
      limit(region.rect);
      place(region);
      say("not saved", "");
    };
    const end = () => target.removeEventListener("pointermove", move);
    target.addEventListener("pointermove", move);
    target.addEventListener("pointerup", end, {once: true});
    target.addEventListener("pointercancel", end, {once: true});
  });
}

function onKey(event, region) {
  const step = event.shiftKey ? 10 : 1;
  const way = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}[event.key];
  if (event.key === "Delete") return remove(region);
  if (!way) return;
  event.preventDefault();
  const at = event.ctrlKey ? 2 : 0;
  region.rect[at] += way[0];
  region.rect[at + 1] += way[1];
  limit(region.rect);
  place(region);
  say("not saved", "");
}

function choice(values, chosen, label, change) {
  const select = document.createElement("select");
  select.setAttribute("aria-label", label);
  for (const value of values.includes(chosen) ? values : [...values, chosen]) select.append(new Option(value, value, false, value === chosen));
  select.addEventListener("change", () => change(select.value));
  return select;
}

function addRow(region) {
  region.row = rows.insertRow();
  const cell = (content) => region.row.insertCell().append(content);
  const name = document.createElement("input");
  name.value = region.name;
  name.maxLength = 32;
  name.setAttribute("aria-label", "name");
  name.addEventListener("input", () => { region.name = name.value; place(region); say("not saved", ""); });
  cell(name);
  cell(choice(["structure", "base", "background", "ground"], region.role, "role", (value) => { region.role = value; place(region); say("not saved", ""); }));
  cell(choice(["u", "v", "both"], region.axis, "axis", (value) => { region.axis = value; say("not saved", ""); }));
  region.inputs = ["left", "top", "width", "height"].map((label, i) => {
    const input = document.createElement("input");
    input.type = "number";
    input.setAttribute("aria-label", label);
    input.addEventListener("change", () => { region.rect[i] = Number(input.value) || 0; limit(region.rect); input.blur(); place(region); say("not saved", ""); });
    cell(input);
    return input;
  });
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = "Remove";
  button.addEventListener("click", () => remove(region));
  cell(button);
}

function add(region) {
  regions.push(region);
  region.shape = element("rect", {tabindex: 0, role: "button"}, picture);
  region.label = element("text", {"font-size": Math.max(width, height) / 55}, picture);
  region.corners = [0, 1, 2, 3].map((i) => {
    const corner = element("circle", {class: "corner"}, picture);
    follow(corner, region, (rect, du, dv) => moveSides(rect, du, dv, i % 2 === 0, i < 2));
    return corner;
  });
  addRow(region);
  follow(region.shape, region, (rect, du, dv) => { rect[0] += du; rect[1] += dv; });
  region.shape.addEventListener("keydown", (event) => onKey(event, region));
  limit(region.rect);
  place(region);
}

function remove(region) {
  regions = regions.filter((other) => other !== region);
  for (const part of [region.shape, region.label, ...region.corners, region.row]) part.remove();
  say("not saved", "");
}

async function save() {
  const body = JSON.stringify({regions: regions.map(({name, rect, role, axis}) => ({name, rect, role, axis}))});
  try {
    const answer = await fetch("/regions", {method: "POST", headers: {"Content-Type": "application/json"}, body});
    say((await answer.text()).trim(), answer.ok ? "good" : "bad");
  } catch (error) {
    say("not saved: the program has ended", "bad");
  }
}

async function begin() {
  const told = await (await fetch("/regions.json")).json();
  [width, height] = told.size;
  picture.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const header = document.querySelector("header");
  new ResizeObserver(() => document.documentElement.style.setProperty("--head", header.offsetHeight + "px")).observe(header);
  element("image", {href: "/frame.png", width, height, preserveAspectRatio: "none"}, picture);
  told.regions.forEach(add);
  document.getElementById("add").addEventListener("click", () => {
    let n = regions.length + 1;
    while (regions.some((region) => region.name === "part" + n)) ++n;
    add({name: "part" + n, rect: [width * 0.4, height * 0.45, width * 0.2, height * 0.1], role: "structure", axis: "u"});
    regions[regions.length - 1].shape.focus();
    say("not saved", "");
  });
  document.getElementById("save").addEventListener("click", save);
}
begin();
