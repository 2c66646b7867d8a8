//! Tables (Markdown, CSV, JSON) and SVG plots from result structs.
