// The picture of a surface by WebGL: vtk.js draws triangles in colours and lines; positions and colours are set here.

import "@kitware/vtk.js/Rendering/Profiles/Geometry";
import vtkActor from "@kitware/vtk.js/Rendering/Core/Actor";
import vtkColorTransferFunction from "@kitware/vtk.js/Rendering/Core/ColorTransferFunction";
import vtkDataArray from "@kitware/vtk.js/Common/Core/DataArray";
import vtkMapper from "@kitware/vtk.js/Rendering/Core/Mapper";
import vtkOpenGLRenderWindow from "@kitware/vtk.js/Rendering/OpenGL/RenderWindow";
import vtkPolyData from "@kitware/vtk.js/Common/DataModel/PolyData";
import vtkRenderWindow from "@kitware/vtk.js/Rendering/Core/RenderWindow";
import vtkRenderer from "@kitware/vtk.js/Rendering/Core/Renderer";
import { rgb } from "d3";

const unit = (colour) => {
  const { r, g, b } = rgb(colour);
  return [r / 255, g / 255, b / 255];
};

/** One actor with its data. */
class Layer {
  constructor(renderer, { lit, colour, opacity = 1, behind = false }) {
    this.data = vtkPolyData.newInstance();
    this.mapper = vtkMapper.newInstance({ interpolateScalarsBeforeMapping: true, useLookupTableScalarRange: true });
    this.mapper.setInputData(this.data);
    if (behind) { // lines on the surface must not be hidden by it
      this.mapper.setResolveCoincidentTopologyToPolygonOffset();
      this.mapper.setResolveCoincidentTopologyPolygonOffsetParameters(1, 1);
    }
    this.actor = vtkActor.newInstance();
    this.actor.setMapper(this.mapper);
    const property = this.actor.getProperty();
    property.setLighting(lit);
    property.setAmbient(lit ? 0.5 : 1); // colours stay those of the scale, slightly darker at an angle
    property.setDiffuse(lit ? 0.5 : 0);
    property.setOpacity(opacity);
    if (colour) property.setColor(...unit(colour));
    renderer.addActor(this.actor);
  }

  setPoints(positions) {
    this.data.getPoints().setData(positions, 3);
    this.data.getPoints().modified();
    this.data.modified();
  }

  /** `cells`: n, then n numbers of points, over and over. */
  setCells(kind, cells) {
    (kind === "lines" ? this.data.getLines() : this.data.getPolys()).setData(cells);
    this.data.modified();
  }

  /** Sets colours from the values at the points; null: its own colour. */
  setValues(values, transfer) {
    this.mapper.setScalarVisibility(values !== null);
    if (values === null) return;
    this.data.getPointData().setScalars(vtkDataArray.newInstance({ name: "values", values, numberOfComponents: 1 }));
    this.mapper.setLookupTable(transfer);
    this.data.modified();
  }
}

/** 3 a, a + 1, a + 2 for a = 3 first, ... */
function triangleCells(first, end) {
  const cells = new Uint32Array(4 * (end - first));
  for (let t = first, place = 0; t < end; ++t) {
    cells[place++] = 3;
    for (let i = 0; i < 3; ++i) cells[place++] = 3 * t + i;
  }
  return cells;
}

/** A scale of colours for vtk.js; `colourAt(s)`, s in [0, 1]. */
function transferFunction({ low, high }, colourAt, n = 128) {
  const transfer = vtkColorTransferFunction.newInstance();
  for (let i = 0; i <= n; ++i) transfer.addRGBPoint(low + ((high - low) * i) / n, ...unit(colourAt(i / n)));
  transfer.setMappingRange(low, high);
  return transfer;
}

export function hasWebGL() {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

export class Scene {
  constructor(place, dimension) {
    this.window = vtkRenderWindow.newInstance();
    this.renderer = vtkRenderer.newInstance();
    this.window.addRenderer(this.renderer);
    this.view = vtkOpenGLRenderWindow.newInstance();
    this.window.addView(this.view);
    this.view.setContainer(place);
    const lit = dimension === 3;
    this.coloured = new Layer(this.renderer, { lit, behind: true });
    this.plain = new Layer(this.renderer, { lit, behind: true, colour: "#b8bec6" });
    this.obstacle = new Layer(this.renderer, { lit, behind: true, colour: "#8c8070" });
    this.lines = new Layer(this.renderer, { lit: false, opacity: 0.32 });
    this.renderer.getActiveCamera().setParallelProjection(true);
  }

  get canvas() {
    return this.view.getCanvas();
  }

  /** Triangles from `first` to `end` are coloured, the others are not. */
  setTriangles(nTriangles, nColoured) {
    this.coloured.setCells("polys", triangleCells(0, nColoured));
    this.plain.setCells("polys", triangleCells(nColoured, nTriangles));
    this.plain.actor.setVisibility(nColoured < nTriangles);
  }

  setPositions(corners, vertices) {
    this.coloured.setPoints(corners);
    this.plain.setPoints(corners);
    this.lines.setPoints(vertices);
  }

  /** Sets values per corner, padded where only the first corners have one, and their colours. */
  setValues(values, nCorners, range, colourAt) {
    let padded = values;
    if (values.length < nCorners) {
      padded = new Float32Array(nCorners);
      padded.set(values);
    }
    this.coloured.setValues(padded, transferFunction(range, colourAt));
    for (const layer of [this.plain, this.lines, this.obstacle]) layer.setValues(null);
  }

  /** Segments as pairs of vertices; null: none. */
  setLines(segments) {
    this.lines.actor.setVisibility(segments !== null);
    if (segments === null) return;
    const cells = new Uint32Array((segments.length / 2) * 3);
    for (let s = 0; s < segments.length / 2; ++s) cells.set([2, segments[2 * s], segments[2 * s + 1]], 3 * s);
    this.lines.setCells("lines", cells);
  }

  /** Corners of triangles; null: none. */
  setObstacle(corners) {
    this.obstacle.actor.setVisibility(corners !== null);
    if (corners === null) return;
    this.obstacle.setPoints(corners);
    this.obstacle.setCells("polys", triangleCells(0, corners.length / 9));
  }

  resize(width, height, background, line) {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.view.setSize(Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio)));
    this.renderer.setBackground(...unit(background), 1);
    this.lines.actor.getProperty().setColor(...unit(line));
  }

  /** `distance`: larger than the body seen from anywhere. */
  render(camera, distance) {
    const { up, eye } = camera.axes();
    const active = this.renderer.getActiveCamera();
    active.setFocalPoint(...camera.target);
    active.setPosition(...camera.target.map((x, i) => x + distance * eye[i]));
    active.setViewUp(...up);
    active.setParallelScale(camera.scale);
    this.renderer.resetCameraClippingRange();
    this.window.render();
  }
}
