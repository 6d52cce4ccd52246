"""Draws surfaces in 3D: perspective, hidden parts removed pixel by pixel. VTK would need a display or a graphics card."""

import numpy as np

FINER = 3  # pixels are drawn this many times finer in both directions, and averaged
DISTANCE = 3.5  # of the viewer, in sizes of the drawn object
DARKEST = 0.62  # shade of a face seen edge-on


class Camera:
    """Looks at the middle of some points from the direction `side`, the direction `up` being upwards."""

    def __init__(self, points, side, up):
        low, high = points.min(axis=0), points.max(axis=0)
        self.middle, self.distance = (low + high) / 2, DISTANCE * np.linalg.norm(high - low)
        back = np.asarray(side, float) / np.linalg.norm(side)
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        self.axes = np.stack([right, np.cross(back, right), back])

    def __call__(self, points):
        """Points x (right, up, nearness); all three are linear along lines of the picture."""
        local = (points - self.middle) @ self.axes.T
        nearness = self.distance / (self.distance - local[:, 2])
        return np.column_stack([local[:, :2] * nearness[:, None], nearness])


class Raster:
    """A picture of `width` pixels: first the triangles, then the lines that lie on them."""

    def __init__(self, points, camera, width):
        self.camera = camera
        flat = camera(points)[:, :2]
        low, high = flat.min(axis=0), flat.max(axis=0)
        margin = 0.01 * (high - low).max()
        self.low = low - margin
        self.scale = FINER * width / (high[0] - low[0] + 2 * margin)
        columns, rows = FINER * np.ceil((high - low + 2 * margin) * self.scale / FINER).astype(int)
        self.nearest = np.full((rows, columns), -np.inf)
        self.colours = np.ones((rows, columns, 3))
        self.values = np.full((rows, columns), np.nan)
        self.shades = np.ones((rows, columns))

    def pixels(self, points):
        flat = self.camera(points)
        flat[:, :2] = (flat[:, :2] - self.low) * self.scale
        return flat

    def draw(self, points, triangles, values, colours):
        """`values` at the points, which `colours` maps to red, green and blue."""
        flat = self.pixels(points)
        normals = np.cross(points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]])
        length = np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)
        light = self.camera.axes.T @ np.array([-0.35, 0.45, 1]) / np.linalg.norm([-0.35, 0.45, 1])
        shades = DARKEST + (1 - DARKEST) * np.abs(normals @ light) / length
        for corners, values_here, shade in zip(flat[triangles], values[triangles], shades):
            self.draw_triangle(corners, values_here, shade)
        drawn = np.isfinite(self.values)
        self.colours[drawn] = colours(self.values[drawn])[:, :3] * self.shades[drawn, None]

    def draw_triangle(self, corners, values, shade):
        low = np.maximum(np.ceil(corners[:, :2].min(axis=0) - 0.5), 0).astype(int)
        high = np.floor(corners[:, :2].max(axis=0) - 0.5).astype(int) + 1
        (ax, ay, _), (bx, by, _), (cx, cy, _) = corners
        twice_area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if twice_area == 0 or np.any(high <= low):
            return
        x, y = np.arange(low[0], high[0]) + 0.5, (np.arange(low[1], high[1]) + 0.5)[:, None]
        b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / twice_area
        c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / twice_area
        a = 1 - b - c
        nearness = a * corners[0, 2] + b * corners[1, 2] + c * corners[2, 2]
        window = np.s_[low[1]:high[1], low[0]:high[0]]
        seen = (np.minimum(np.minimum(a, b), c) >= 0) & (nearness > self.nearest[window])
        self.nearest[window][seen] = nearness[seen]
        self.values[window][seen] = (a * values[0] + b * values[1] + c * values[2])[seen]
        self.shades[window][seen] = shade

    def line(self, points, edges, width, strength):
        """Lines along rows of points, where nothing is in front of them: black, as opaque as `strength` says."""
        flat = self.pixels(points)
        begin, end = flat[edges[:, :-1]].reshape(-1, 3), flat[edges[:, 1:]].reshape(-1, 3)
        count = np.ceil(2 * np.linalg.norm(end[:, :2] - begin[:, :2], axis=1)).astype(int) + 1
        line = np.repeat(np.arange(len(count)), count)
        share = (np.arange(len(line)) - np.repeat(np.cumsum(count) - count, count)) / np.maximum(count - 1, 1)[line]
        x, y, nearness = (begin[line] + share[:, None] * (end - begin)[line]).T
        drawn = np.zeros(self.nearest.shape, bool)
        rows, columns = drawn.shape
        in_front = nearness + 0.002 / DISTANCE  # what lies on a face is not hidden by it
        for dx in np.arange(width) - (width - 1) / 2:
            for dy in np.arange(width) - (width - 1) / 2:
                i, j = np.clip((y + dy).astype(int), 0, rows - 1), np.clip((x + dx).astype(int), 0, columns - 1)
                seen = self.nearest[i, j] <= in_front
                drawn[i[seen], j[seen]] = True
        self.colours[drawn] *= 1 - strength

    def image(self):
        """Rows x columns x 3, the first row on top."""
        rows, columns = self.nearest.shape
        return self.colours.reshape(rows // FINER, FINER, columns // FINER, FINER, 3).mean(axis=(1, 3))[::-1]
