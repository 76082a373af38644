// RAII for C++ programs over the C interface, and mesh data from a shape that is already built.
#pragma once

#include <memory>
#include <utility>

#include "odds/math/error.hpp"
#include "odds/ode/odds_ode.h"
#include "odds/query/shape.hpp"

namespace odds::ode {

/// Mesh data that shares an existing shape (no rebuild). Null, with oddsGetLastError(), if `shape` is null or memory
/// ran out. The caller owns the id: oddsMeshDataDestroy.
[[nodiscard]] oddsMeshDataID oddsMeshDataFromShape(std::shared_ptr<const query::Shape> shape) noexcept;

/// Holds ODE and the geom class for its life time (oddsInitODE / oddsCloseODE). Must outlive every Geom.
class Library {
 public:
  /// oddsInitODE(flags) for the calling thread; counted, so that any number may be open. An error, with the sentence of
  /// oddsGetLastError(), if ODE refuses. Any thread, for set-up: not while another one collides.
  [[nodiscard]] static Result<Library> open(unsigned flags = 0);
  ~Library() {
    if (open_) oddsCloseODE();
  }
  Library(Library&& other) noexcept : open_(std::exchange(other.open_, false)) {}
  Library& operator=(Library&& other) noexcept {
    std::swap(open_, other.open_);
    return *this;
  }

 private:
  Library() noexcept : open_(true) {}
  bool open_;
};

/// Owns one geom; destroys it at the end. Not needed if ODE owns the geom through its space.
class Geom {
 public:
  /// A geom of that shape, which may be shared by any number of geoms, put into `space`, or into none if that is null.
  /// A space with cleanup would destroy it, too: then release() it. An error, with the sentence of oddsGetLastError(),
  /// if the library is not open, the shape is null or without polygons, or memory ran out; then nothing was made. For
  /// set-up: not while another thread uses the space.
  [[nodiscard]] static Result<Geom> make(dSpaceID space, std::shared_ptr<const query::Shape> shape);
  ~Geom() {
    if (id_ != nullptr) dGeomDestroy(id_);
  }
  Geom(Geom&& other) noexcept : id_(std::exchange(other.id_, nullptr)) {}
  Geom& operator=(Geom&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }

  [[nodiscard]] dGeomID id() const noexcept { return id_; }
  /// Gives the geom away; the caller (or its space) destroys it.
  [[nodiscard]] dGeomID release() noexcept { return std::exchange(id_, nullptr); }

 private:
  explicit Geom(dGeomID id) noexcept : id_(id) {}
  dGeomID id_;
};

}  // namespace odds::ode
