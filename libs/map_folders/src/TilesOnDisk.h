#pragma once
#include <map_folders/MapFolder.h>
#include <semantic_octree/store/MapAccess.h>
#include <semantic_octree/store/TileCodes.h>
#include <strict_files/OutputFiles.h>

#include <set>
#include <unordered_map>

#include "TileIndex.h"

namespace semantic_octree {

/** Which tiles of a map are in memory, and where the others are. A tile is an inner node at a
 * depth. If it goes away, it keeps its value and bookkeeping; nothing above has to know. */
class MapFolder::Tiles final : public TileSource {
 public:
  Tiles(SemanticOcTree& map, std::filesystem::path folder, Access access,
        const MapFolderOptions& options);
  ~Tiles() override;

  void bring(Slot& away) override;
  void prepare(const Scan& scan) override;
  void sendAway() override;
  void clear() override { m_tiles.clear(); }
  bool mayChange() const override { return m_unsaved.has_value(); }
  int depth() const override { return m_index.depth; }
  void changed(const Cube& cell) override;
  bool mayHold(const Slot& away, const ClassSet& classes) const override;
  void checkFits(std::optional<std::size_t> available) const override;

  void save();
  void bringAll();
  void onTile(std::function<void(std::size_t)> told);
  std::vector<std::string> problems();
  Contents contents() const;

 private:
  struct Tile {
    VoxelIndex place;
    std::uint64_t written = 0;  ///< generation of its file; 0: it has none
    std::uint64_t used = 0;     ///< when, by m_clock
    bool isAway = false, isDirty = false;
    long nodes = 0, innerNodes = 0;  ///< below it, if it is away
    std::uint32_t checksum = 0;      ///< of its file
    /** See halfLivesBelow(), if it is away. None: nobody has looked. */
    std::optional<ClassSet> halfLives = {};
  };
  using Entry = std::pair<const std::uint64_t, Tile>;

  NodeStore& store() const { return MapAccess::store(m_map); }
  Cube cellOf(const Tile& tile) const { return cubeAt(tile.place, m_index.depth); }
  bool isOfMap() const { return !m_map.isBroken() && store().tiles() == this; }
  bool saves() const { return m_access == Access::Write || m_access == Access::Replace; }

  // The folder.
  TileIndex open(const MapFolderOptions& options);
  void takeContents();
  /** Adds the tiles that the index has to a map that has none. */
  void addFromIndex();
  /** Writes what changed as files of the next generation. \return the index, but for leaves */
  TileIndex writeChanged();
  std::vector<std::string> oldFor(const TileIndex& next) const;
  void place(const TileIndex& index);
  void removeOld() const;
  void removePlaced();

  // The tiles.
  /** Where it is, or is to be written. */
  std::string fileOf(const Tile& tile) const;
  /** Morton codes of the tiles, which is the order of whatever goes depth first. */
  std::vector<std::uint64_t> sortedCodes() const;
  NodeArena& arenaWith(bool most);
  /** Null: it is no inner node (any more). */
  Slot* slotOf(const Tile& tile) const;
  void fetch(Slot& slot, Tile& tile);
  void fetchIntoBudget(Slot& slot, Tile& tile);
  void read(Slot& slot, const Tile& tile);
  void send(Slot& slot, Tile& tile);
  void removeChildren(NodeArena& arena, const Slot& octant);
  void write(const Slot& slot, Tile& tile);
  /** Sends tiles away that were used before a time, until the rest is within the budget. */
  void makeRoom(std::uint64_t usedBefore, std::size_t budget);

  SemanticOcTree& m_map;
  std::filesystem::path m_folder;
  Access m_access;
  std::optional<strict_files::FileLock> m_writer, m_reader;
  std::optional<strict_files::OutputFolder> m_unsaved;  ///< of those who write
  std::set<std::string> m_placed;  ///< files that a save which then failed put into the folder
  TileIndex m_index;               ///< as it was saved
  std::uint64_t m_next = 0;        ///< generation
  std::size_t m_budget = 0;        ///< bytes

  std::unordered_map<std::uint64_t, Tile> m_tiles;  ///< by Morton code
  std::uint64_t m_clock = 0;
  std::size_t m_broughtIn = 0, m_sentOut = 0;
  std::function<void(std::size_t)> m_told;
  std::vector<std::uint64_t> m_order;  ///< of those there were when onTile() was called
};

}  // namespace semantic_octree
