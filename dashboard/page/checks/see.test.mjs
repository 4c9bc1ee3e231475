// She is seen to walk: pixels, joint angles of the scene graph, and what lies around her.

import assert from "node:assert/strict";
import { after, afterEach, before, test } from "node:test";
import { Bench, difference } from "./harness.mjs";

const bench = new Bench();
before(() => bench.open("walk_2kmh"));
after(() => bench.close());
afterEach(() => bench.clean());

/** Waits until she walks, and does not stop soon. */
const walking = (page) => page.waitForFunction(() => {
  const time = window.gangwerk.state.tick / 1000;
  return time > 5 && time < 14;
}, null, { timeout: 25000 });

test("pixels change where she is, and not in the sky", async () => {
  const page = await bench.page();
  await page.getByRole("button", { name: "side", exact: true }).click();
  await walking(page);
  const { x, y } = await page.evaluate(() => window.gangwerk.view.place());
  const legs = { x: x - 100, y, width: 200, height: 220 };
  const sky = { x: 60, y: 140, width: 200, height: 60 };
  const shots = async (clip) => [await page.screenshot({ clip }), (await page.waitForTimeout(400), await page.screenshot({ clip }))];
  const moved = await difference(page, ...(await shots(legs)));
  const still = await difference(page, ...(await shots(sky)));
  assert.ok(moved > 0.03, `${moved} of the pixels around her legs changed`);
  assert.ok(still < 0.01, `${still} of the pixels of the sky changed`);
  await page.done();
});

test("joint angles of the scene graph are those of the log", async () => {
  const page = await bench.page();
  await walking(page);
  const { recording } = bench.mock;
  for (let k = 0; k < 20; k++) {
    const drawn = await page.evaluate((n) => {
      const { view } = window.gangwerk;
      return { tick: view.measure.tick, angles: Array.from({ length: n }, (_, i) => view.bodies.solid.angle(i)), p: view.bodies.solid.root.position.toArray() };
    }, recording.joints.length);
    const frame = recording.frames[recording.ticks.indexOf(drawn.tick)];
    for (const [i, name] of recording.joints.entries()) {
      const expected = frame[recording.place.get("joint_angle") + i];
      assert.ok(Math.abs(drawn.angles[i] - expected) < 1e-5, `${name} at tick ${drawn.tick}: drawn ${drawn.angles[i]}, logged ${expected}`);
    }
    for (let d = 0; d < 3; d++) assert.equal(drawn.p[d], frame[recording.place.get("torso") + d]);
    await page.waitForTimeout(80);
  }
  await page.done();
});

test("her soles lie where the log says that her feet are", async () => {
  // Another route to the same place: forward kinematics of the browser against that of the simulation.
  const page = await bench.page();
  await walking(page);
  const drawn = await page.evaluate(() => {
    const { view } = window.gangwerk;
    const link = view.bodies.solid.link("right_toe");
    const sole = link.children[0].position.clone().set(0.04, 0, -0.02).applyMatrix4(link.matrixWorld);
    return { tick: view.measure.tick, sole: sole.toArray(), torso: view.bodies.solid.root.position.toArray() };
  });
  const [, truth] = bench.mock.recording.series.find(([topic]) => topic === "controller_state");
  const row = truth.rows[drawn.tick];
  const value = (name) => row[truth.columns.indexOf(name)];
  // Both relative to the torso, and in the heading of the planning frame.
  const heading = value("origin[2]");
  const [dx, dy] = [value("feet[0][0]") - value("torso[0]"), value("feet[0][1]") - value("torso[1]")];
  const expected = [Math.cos(heading) * dx - Math.sin(heading) * dy, Math.sin(heading) * dx + Math.cos(heading) * dy, value("feet[0][2]") - value("torso[2]")];
  for (let d = 0; d < 3; d++) {
    const got = drawn.sole[d] - drawn.torso[d];
    assert.ok(Math.abs(got - expected[d]) < 0.012, `${"xyz"[d]} of the right sole from the torso: drawn ${got} m, logged ${expected[d]} m`);
  }
  await page.done();
});

test("no link floats: every joint begins at an outline of the link that it hangs on", async () => {
  const page = await bench.page();
  const floating = await page.evaluate(() => {
    const { root } = window.gangwerk.view.bodies.solid;
    const off = [];
    for (const link of Object.values(root.links)) {
      const meshes = [];
      for (const child of link.children) if (!child.isURDFJoint) child.traverse((o) => o.isMesh && meshes.push(o));
      for (const joint of link.children.filter((c) => c.isURDFJoint)) {
        const place = joint.getWorldPosition(joint.position.clone());
        // Of each mesh the box in its own frame: rods and cylinders lie along an axis of theirs.
        const least = Math.min(...meshes.map((mesh) => {
          mesh.geometry.computeBoundingBox();
          const nearest = mesh.geometry.boundingBox.clampPoint(mesh.worldToLocal(place.clone()), place.clone());
          return mesh.localToWorld(nearest).distanceTo(place);
        }));
        if (!(least <= 0.02)) off.push(`${joint.name} is ${least.toFixed(3)} m off ${link.name}`);
      }
    }
    return off;
  });
  assert.deepEqual(floating, []);
  await page.done();
});

test("layers are shown and hidden", async () => {
  const page = await bench.page();
  await walking(page);
  const steps = () => page.evaluate(() => {
    let shown = 0;
    window.gangwerk.view.bodies.solid.root.parent.traverse((o) => { if (o.isSprite && o.parent.visible) shown++; });
    return shown;
  });
  assert.ok((await steps()) >= 2, `${await steps()} planned steps are shown`);
  await page.getByRole("button", { name: "Steps" }).click();
  await page.waitForTimeout(500);
  assert.equal(await steps(), 0);
  await page.done();
});

test("the first picture comes soon, and enough of them after it", async (t) => {
  const page = await bench.page();
  await page.waitForTimeout(4000);
  const measure = await page.evaluate(() => window.gangwerk.view.measure);
  t.diagnostic(`first picture after ${Math.round(measure.firstPicture)} ms, ${measure.perSecond.toFixed(1)} frames/s`);
  await page.done();
});
