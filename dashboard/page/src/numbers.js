// Numbers as people read them.

/** Number with as many digits as it deserves: 3 significant ones, no exponent between 0.001 and 100000. */
export function short(x) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  const size = Math.abs(x);
  if (size === 0) return "0";
  if (size < 1e-4 || size >= 1e5) return x.toExponential(2).replaceAll("-", "−");
  const digits = Math.max(0, 3 - Math.ceil(Math.log10(size) + 1e-9));
  return x.toFixed(Math.min(digits, 6)).replace("-", "−");
}

/** Number in full, as it would be typed; none is a dash. */
export const exact = (x) => (Number.isFinite(x) ? String(Number(x.toPrecision(9))) : short(x));

/** Number with a fixed count of digits and a real minus sign, so that columns do not jump. */
export function fixed(x, digits) {
  if (!Number.isFinite(x)) return "–";
  const text = x.toFixed(digits);
  // Of a number that rounds to zero the sign says nothing.
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** Range with its unit; an end that nobody set is any number. */
export function range(low, high, unit) {
  const end = (x, none) => (Number.isFinite(x) ? exact(x).replace("-", "−") : none);
  return `${end(low, "any")} … ${end(high, "any")}${unit && unit !== "-" ? ` ${unit}` : ""}`;
}

/** Unit for display: none is empty. */
export const unitOf = (unit) => (!unit || unit === "-" ? "" : unit);
