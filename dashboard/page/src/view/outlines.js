// Thin outlines for links that have none and for gaps between a link and the next joint: nothing of a robot floats.

import { Box3, CylinderGeometry, Group, Matrix4, Mesh, MeshBasicMaterial, Vector3 } from "three";

const UP = new Vector3(0, 1, 0);
const RADIUS = 0.016; // [m]
const GAP = 0.015; // [m] between an outline and a joint from which it is bridged

/**
 * Adds to each link of `robot` a rod from its outline (from its own joint, if it has no outline) to every joint of its
 * children that lies off the outline. Returns the names of the links that got one.
 */
export function bridgeGaps(robot) {
  const mended = [];
  robot.updateMatrixWorld(true);
  for (const link of Object.values(robot.links)) {
    const box = outline(link);
    let added = false;
    for (const joint of link.children) {
      if (!joint.isURDFJoint) continue;
      const end = joint.position;
      // Nearest point of the outline, or the link's own joint.
      const begin = box.isEmpty() ? new Vector3() : box.clampPoint(end, new Vector3());
      if (begin.distanceTo(end) <= GAP) continue;
      // Into the outline by a diameter, so that no slit is left at a rounded one.
      if (!box.isEmpty()) begin.addScaledVector(new Vector3().subVectors(end, begin).normalize(), -2 * RADIUS);
      link.add(rod(begin, end));
      added = true;
    }
    if (added) mended.push(link.name);
  }
  return mended;
}

/** Box around the visuals of a link, in its frame; empty if it has none. Its world matrix must be up to date. */
export function outline(link) {
  const box = new Box3();
  const inverse = new Matrix4().copy(link.matrixWorld).invert();
  for (const visual of link.children) {
    if (!visual.isURDFVisual) continue;
    visual.traverse((mesh) => {
      if (!mesh.isMesh) return;
      mesh.geometry.computeBoundingBox();
      box.union(mesh.geometry.boundingBox.clone().applyMatrix4(new Matrix4().multiplyMatrices(inverse, mesh.matrixWorld)));
    });
  }
  return box;
}

/** Rod between two points of a link. */
function rod(begin, end) {
  const along = new Vector3().subVectors(end, begin);
  const mesh = new Mesh(new CylinderGeometry(RADIUS, RADIUS, along.length(), 12), new MeshBasicMaterial({ name: "dark" }));
  mesh.position.addVectors(begin, end).multiplyScalar(0.5);
  mesh.quaternion.setFromUnitVectors(UP, along.normalize());
  const group = new Group();
  group.add(mesh);
  return group;
}
