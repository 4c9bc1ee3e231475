// Address of the page: the token, and of a recording the instant that it opens at: #TOKEN&t=12.345&offset=0.5

/** What an address says behind its #: {token, time, offset}; time NaN: none. */
export function readAddress(hash) {
  const [token, ...parts] = hash.replace(/^#/, "").split("&");
  const values = new URLSearchParams(parts.join("&"));
  const number = (key, none) => {
    const text = values.get(key);
    const x = text === null || text.trim() === "" ? none : Number(text);
    return Number.isFinite(x) ? x : none;
  };
  return { token, time: number("t", NaN), offset: number("offset", 0) };
}

/** The same as text, with as many digits as a cycle needs. */
export function writeAddress({ token, time, offset }, digits) {
  return `#${token}&t=${time.toFixed(digits)}${offset ? `&offset=${Number(offset.toFixed(digits))}` : ""}`;
}
