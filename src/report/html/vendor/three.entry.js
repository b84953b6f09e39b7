// What the page needs of three.js; `README.md` has the command that bundles it.
export { Color, OrthographicCamera, Scene, Vector3, WebGLRenderer } from "three";
export { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
export { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
export { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
