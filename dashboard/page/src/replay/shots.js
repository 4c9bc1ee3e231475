// Pictures and videos of the view, as files.

const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
const RATE = 30; // pictures per second of a video

/** Saves `blob` as a download with this name. */
function save(blob, name) {
  const address = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}

/** One picture of the view, as a PNG file; resolves to its size in bytes. */
export async function savePicture(view, name) {
  const blob = await view.picture();
  if (!blob) throw new Error("no picture: this browser has no WebGL 2");
  save(blob, `${name}.png`);
  return blob.size;
}

/** Recorder of what the canvas shows. */
export class Video {
  #recorder = null;

  /** Whether it is recording. */
  get running() {
    return this.#recorder !== null;
  }

  /** Begins; what it recorded is saved as `name` when it ends. Throws where the browser cannot. */
  begin(canvas, name, saved) {
    const type = TYPES.find((t) => globalThis.MediaRecorder?.isTypeSupported(t));
    if (!type || !canvas.captureStream) throw new Error("no video: this browser has no MediaRecorder for its canvas");
    const recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: type, videoBitsPerSecond: 8e6 });
    const parts = [];
    recorder.ondataavailable = ({ data }) => data.size && parts.push(data);
    recorder.onstop = () => {
      for (const track of recorder.stream.getTracks()) track.stop();
      const blob = new Blob(parts, { type: type.split(";")[0] });
      save(blob, `${name}.${type.includes("mp4") ? "mp4" : "webm"}`);
      saved(blob.size);
    };
    recorder.start(500);
    this.#recorder = recorder;
  }

  /** Ends, and saves. */
  end() {
    this.#recorder?.stop();
    this.#recorder = null;
  }
}
