//! Flight dynamics of flexible high-aspect-ratio aircraft: the facade and the case file.
