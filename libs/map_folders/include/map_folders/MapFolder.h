#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/OptionList.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace semantic_octree {

/** How a map is kept in a folder. */
struct MapFolderOptions {
  /** MB (10^6 bytes) of nodes, records and bookkeeping that may be in memory. What one scan, or one
   * tile, needs is always taken. */
  double memory = 500;
  /** Meters: edge of a tile of a new folder; the next smaller power of two voxels is used. */
  double tileSize = 51.2;
  /** For a folder that is opened to be read: only tiles for whose cube (meters, map frame) this
   * answers true; the others' are unknown space. None: all tiles. */
  std::function<bool(const Eigen::AlignedBox3d& cube)> wanted = {};
  /** For a folder that is opened to be read: a folder where tiles that changed go when memory is
   * short. It is created, and goes with the MapFolder. With it the map may change; it is not saved,
   * and the folder stays as it is. */
  std::filesystem::path draft = {};

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** A map that may be larger than memory. Its parts are in a folder, one file a tile. They come in
 * when a scan, a query or anything else that reads nodes needs them. Those used least lately go out
 * (scans and incoming tiles are uses) where there are more than the budget allows.
 *
 * The map stays an ordinary map, the same to the last bit as without a folder. What is above the
 * tiles, and the tiles' own mixtures and G-values, stays in memory. Beside what SemanticOcTree
 * says:
 * - A Node within a tile is valid until another tile comes in. Whatever goes through a tree depth
 *   first (iterators, files, sums, the abstraction's measures and compressedMap()) can do so;
 *   Abstraction::leaves() tells cubes, but its nodes may be gone.
 * - Reading is changing: not from two threads, and it may throw std::runtime_error naming a file.
 * - What goes through all of it reads all tiles, and writes those that it changes: each step of a
 *   half-life (SemanticOcTree::age()), corrections (KeyframeMap) where they move something. If a
 *   file fails then, the map is broken, and the folder what it was when it was last saved.
 * - A copy is a map in memory. It is made if there is memory for all of it: std::runtime_error says
 *   how much it takes.
 * - After clear() the next save() replaces what was there, as with Access::Replace.
 * - It has to stay where it is.
 * - If setAbstraction() cannot read a tile, the map keeps no abstraction. If that happens to what
 *   Abstraction changes (setWeights() and the like), setAbstraction() has to be called anew.
 *
 * Nothing that was saved is touched before the next save(), which is done when the index takes its
 * place. Whenever the process ends, the folder is what it was when it was last saved. One process
 * writes, others read what was saved when they opened it. The index tells the checksum and counts
 * of each file, and its own. A file is compared with them when it is read. It is removed only if an
 * index calls it old (doc/handbook/large-maps.md). */
class MapFolder {
 public:
  enum class Access {
    Read,
    Write,
    Replace  ///< to write, but the map begins empty: with the first save() all that was there goes
  };

  /** The file that makes a folder one. */
  static constexpr const char* kIndexFile = "index.yaml";
  /** Whether a map was saved there. */
  static bool isAt(const std::filesystem::path& folder);
  /** Files that no save of a folder names: put there, or left by a process that was killed. Who
   * writes next removes only what such a process had not begun to save. */
  struct Others {
    std::size_t files = 0;
    std::uint64_t bytes = 0;
  };
  /** \throw std::runtime_error as loadTree() */
  static Others othersAt(const std::filesystem::path& folder);
  /** An empty map like that of a folder. \throw std::runtime_error as loadTree() */
  static SemanticOcTree emptyMap(const std::filesystem::path& folder);

  /** Makes a map what the folder says, also its clock. For writing, the folder may be new.
   * \param map empty, like that of the folder, but for half-lives: those of its classes hold; must
   * outlive this
   * \throw std::invalid_argument the map is not empty, or is in a folder; bad options
   * \throw std::runtime_error naming the folder or file: it cannot be read or written, is of
   * another resolution, classes or parameters, or another process writes into it. */
  MapFolder(SemanticOcTree& map, const std::filesystem::path& folder, Access access,
            const MapFolderOptions& options = {});
  /** What was not saved is lost. */
  ~MapFolder();
  MapFolder(const MapFolder&) = delete;
  MapFolder& operator=(const MapFolder&) = delete;

  /** Brings what changed to the disk. If this fails, the map and the folder are what they were.
   * \throw std::runtime_error naming the file; std::logic_error opened to be read. */
  void save();
  /** \param available bytes of memory; without, those that the system has left
   * \throw std::runtime_error naming the bytes that the map needs as a whole, if these are more */
  void checkFits(std::optional<std::size_t> available = {}) const;
  /** Has all tiles in memory, whatever the budget: the map may then outlive this.
   * \throw std::runtime_error as checkFits(), before it begins */
  void bringAll(std::optional<std::size_t> available = {});

  /** Calls this each time that a tile has come in, until it is given another or none. Tiles are
   * counted from 0 in the order in which whatever goes depth first needs them; others need not
   * come. */
  void onTile(std::function<void(std::size_t number)> told);

  /** What is wrong with tiles, each naming its file: missing, cut, altered. Reads all of them. */
  std::vector<std::string> problems();

  struct Contents {
    std::size_t tiles = 0, tilesInMemory = 0;
    double tileSize = 0;           ///< meters
    std::uint64_t generation = 0;  ///< 0: nothing was saved
    std::uint64_t bytesOnDisk = 0;
    std::size_t broughtIn = 0, sentOut = 0;  ///< tiles, so far
  };
  Contents contents() const;

 private:
  class Tiles;
  std::unique_ptr<Tiles> m;
};

/** A map that was saved, in one file or in a folder of tiles, for whatever reads it depth first and
 * from one thread. Others have loadMap(). */
class StoredMap {
 public:
  /** \param options of a folder that is read \throw std::runtime_error as loadTree() */
  explicit StoredMap(const std::filesystem::path& path, const MapFolderOptions& options = {});
  /** \param memory, wanted see MapFolderOptions */
  StoredMap(const std::filesystem::path& path, double memory,
            decltype(MapFolderOptions::wanted) wanted = {})
      : StoredMap(path, MapFolderOptions{memory, MapFolderOptions().tileSize, std::move(wanted)}) {}
  /** One that is in memory. */
  explicit StoredMap(SemanticOcTree tree) : m_tree(std::move(tree)) {}
  /** An empty one, to be filled (MapOperations.h) and saved in place of what the folder has.
   * \throw std::runtime_error as MapFolder */
  StoredMap(SemanticOcTree empty, const std::filesystem::path& folder,
            const MapFolderOptions& options);
  StoredMap(const StoredMap&) = delete;
  StoredMap& operator=(const StoredMap&) = delete;

  SemanticOcTree& tree() { return m_tree; }
  /** Null: it is in one file. */
  MapFolder* folder() { return m_folder.get(); }
  std::uint64_t bytesOnDisk() const { return m_bytesOnDisk; }

 private:
  SemanticOcTree m_tree;
  std::unique_ptr<MapFolder> m_folder;
  std::uint64_t m_bytesOnDisk = 0;
};

/** All of a map that was saved, in one file or in a folder of tiles.
 * \throw std::runtime_error as loadTree() and MapFolder::bringAll() */
SemanticOcTree loadMap(const std::filesystem::path& path);

}  // namespace semantic_octree
