// serve/page/panel.js - the panel of controls: what it shows, and the options that it stands for.
// SPDX-License-Identifier: Apache-2.0
import {cameraAlong, cameraAt, depthOf, eyeOf} from "/stage.js";

export const form = document.getElementById("controls");
export const controls = form.elements;
const byId = (id) => document.getElementById(id);
let displays = [];  // of the server, with their views

/** A new element with a text and properties. */
export function element(tag, text, properties = {}) {
  return Object.assign(document.createElement(tag), {textContent: text}, properties);
}

// ---- Where the camera is ----

/** The orbit camera before it is moved by hand. */
export function placedCamera(view) {
  const index = controls.camera.value;
  if (index === "") return cameraAt(view.camera);
  return cameraAlong(view.asset.cameras[index], view.asset);
}

/** What tells one placing from another: the orbit camera, or which camera is chosen. */
export function currentPlace(camera) {
  return camera ?? controls.camera.value;
}

// ---- From the controls to the options of a wish ----

export function wishSize() {
  const stage = byId("stage");
  const choice = controls.resolution.value;
  if (choice.includes("x")) return choice.split("x").map(Number);
  const shown = [stage.clientWidth, stage.clientHeight];
  return shown.map((pixels) => Math.max(16, Math.round(pixels * choice)));
}

/** Coordinates with as many digits as can be seen from that far. */
function coordinates(point, distance) {
  const digits = 4 - Math.floor(Math.log10(distance));
  return point.map((x) => Number(x.toFixed(Math.min(Math.max(digits, 0), 12)))).join(",");
}

/** Which one the option names: by name, or by number where names do not tell. */
function nameOrIndex(list, index) {
  const {name} = list[index];
  return name && list.filter((other) => other.name === name).length === 1 ? name : String(index);
}

function cameraOptions({view, camera}) {
  if (camera) {
    const fov = Number(camera.fov.toFixed(3));
    const text = (point) => coordinates(point, camera.distance);
    return {eye: text(eyeOf(camera)), target: text(camera.target), up: "0,1,0", fov};
  }
  const index = controls.camera.value;
  return index === "" ? {} : {camera: nameOrIndex(view.asset.cameras, index)};
}

/** What the picked point may move with: the pixel shows something else at another pose. */
export function currentPose(view) {
  return JSON.stringify(assetOptions(view));
}

/** What is sharp stays so when the camera moves: the pixel then shows something else. */
function lensOptions({view, camera, sharp}, size) {
  if (!controls.fstop.value) return {};
  const fstop = Number(controls.fstop.value);
  if (controls.focus.value) return {fstop, "focus-distance": Number(controls.focus.value)};
  if (!sharp) return {fstop};
  const isAsPicked = sharp.place === currentPlace(camera) && sharp.size === size.join("x") &&
    sharp.pose === currentPose(view);
  if (isAsPicked) return {fstop, "focus-on": sharp.pixel};
  const depth = depthOf(camera ?? placedCamera(view), sharp.point);
  return depth > 0 ? {fstop, "focus-distance": Number(depth.toPrecision(5))} : {fstop};
}

/** Other layers have no noise, and no shadows to catch. */
const showsLight = () => controls.integrator.value === "path";

function lightOptions() {
  const options = {};
  const env = controls.env.value;
  const sun = `${controls.skyElevation.value},${controls.skyAzimuth.value}`;
  if (env) options.env = env === "sky" ? `sky:${sun}` : env;
  if (controls.rotation.value !== "0") options["env-rotation"] = Number(controls.rotation.value);
  const intensity = Number(controls.intensity.value);
  if (intensity !== 1) options["env-intensity"] = intensity;
  if (controls.background.value === "page") options.page = "white";
  else if (controls.background.value) options.background = controls.background.value;
  if (controls.catcher.checked && showsLight()) options.catcher = "ground";
  return options;
}

/** The first display and its first view are what is without these options. */
function lookOptions() {
  const options = {};
  const [display, tone] = [controls.display, controls.view];
  if (Number(controls.exposure.value)) options.exposure = Number(controls.exposure.value);
  if (display.selectedIndex > 0) options.display = display.value;
  if (display.selectedIndex > 0 || tone.selectedIndex > 0) options.view = tone.value;
  if (controls.integrator.value !== "path") options.integrator = controls.integrator.value;
  if (controls.denoise.checked && showsLight()) options.denoise = true;
  return options;
}

function assetOptions(view) {
  const options = {};
  if (controls.variant.value) options.variant = controls.variant.value;
  if (controls.animation.value) {
    options.animation = nameOrIndex(view.asset.animations, controls.animation.value);
    options.time = Number(controls.time.value);
  }
  return options;
}

/**
 * All options of the picture that the controls stand for; `shot` has the view, the orbit camera
 * or null, and the point that is sharp or null.
 */
export function optionsOf(shot) {
  const size = wishSize();
  return {
    size: size.join("x"), spp: Number(controls.spp.value), ...assetOptions(shot.view),
    ...cameraOptions(shot), ...lensOptions(shot, size), ...lightOptions(), ...lookOptions(),
  };
}

// ---- Choices and values that are shown ----

export function showChoices(choices) {
  displays = choices.displays;
  const layers = choices.layers.map(({name, title}) => {
    const label = element("label", "");
    const input = element("input", "", {type: "radio", name: "integrator", value: name, title});
    input.checked = name === "path";
    label.append(input, element("span", title));
    return label;
  });
  byId("layers").replaceChildren(...layers);
  const plain = choices.environments.filter((name) => !name.startsWith("sky:"));
  const sky = choices.environments.some((name) => name.startsWith("sky:")) ? ["sky"] : [];
  fillSelect("env", ["As the file has it", ...plain, ...sky], ["", ...plain, ...sky]);
  fillSelect("display", displays.map(({name}) => name));
  showTones();
  byId("version").textContent = `Obscura ${choices.version}`;
}

/** The views of the display that is chosen. */
export function showTones() {
  fillSelect("view", displays[controls.display.selectedIndex].views);
}

/** Lists the files of the server: models to open, environments to choose. */
export function showFiles(files, openFile) {
  const models = files.filter(({kind}) => kind === "model").map(({file}) => {
    const item = element("li", "");
    const onclick = () => openFile(file);
    item.append(element("button", file, {type: "button", onclick}));
    return item;
  });
  byId("root-files").replaceChildren(...models);
  for (const {file, kind} of files) if (kind === "environment") listEnvironment(file);
}

/** What follows from the controls: numbers beside sliders, rows that only matter now and then. */
export function showValues(sharp) {
  for (const output of form.querySelectorAll("output")) {
    const value = Number(byId(output.htmlFor.value).value);
    output.value = Number(value.toFixed(2)) + output.dataset.unit;
  }
  for (const row of form.querySelectorAll(".sky")) row.hidden = controls.env.value !== "sky";
  controls.focus.disabled = !controls.fstop.value;
  controls.focus.placeholder = sharp ? "at the picked point" : "at the target";
  byId("stage").classList.toggle("see-through", controls.background.value === "transparent");
}

function fillSelect(name, titles, values = titles) {
  const rows = titles.map((title, i) => element("option", title, {value: values[i]}));
  controls[name].replaceChildren(...rows);
}

/** Makes an environment one of those that may be chosen. */
export function listEnvironment(file, title = file) {
  const isListed = [...controls.env.options].some((option) => option.value === file);
  if (!isListed) controls.env.append(element("option", title, {value: file}));
}

/** What the asset has to choose from; what it has not is not shown. */
export function showAsset(asset) {
  const named = (list, what) => list.map(({name}, i) => name || `${what} ${i + 1}`);
  const numbers = (list) => ["", ...list.keys()];
  const start = asset.cameras.length ? "As the file opens" : "Whole model";
  fillSelect("camera", [start, ...named(asset.cameras, "Camera")], numbers(asset.cameras));
  controls.camera.append(element("option", "Moved by hand", {value: "free", hidden: true}));
  fillSelect("variant", ["As stored", ...asset.variants], ["", ...asset.variants]);
  const motions = named(asset.animations, "Animation");
  fillSelect("animation", ["At rest", ...motions], numbers(asset.animations));
  byId("variant-group").hidden = !asset.variants.length;
  byId("animation-group").hidden = !asset.animations.length;
  byId("warnings-group").hidden = !asset.warnings.length;
  byId("warning-count").textContent = asset.warnings.length;
  byId("warnings").replaceChildren(...asset.warnings.map((text) => element("li", text)));
  const triangles = asset.triangles.toLocaleString("en");
  byId("asset-name").textContent = `${asset.name} · ${triangles} triangles`;
  document.title = `${asset.name} – Obscura`;
}
