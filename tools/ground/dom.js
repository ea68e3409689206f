// What every part of the page needs of the document.
export const byId = (id) => document.getElementById(id);
export const text = (node, value) => { if (node.textContent !== value) node.textContent = value; };
export const fixed = (value, digits = 3) => (value === null || value === undefined ? "–" : String(Number(value.toPrecision(digits))));
