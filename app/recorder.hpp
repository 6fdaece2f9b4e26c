#pragma once
// What a run leaves behind: the folder with its records, history.csv, the probes' files and the frames.

#include <memory>
#include <vector>

#include "app/command_line.hpp"
#include "app/scene.hpp"
#include "app/simulation.hpp"
#include "io/csv.hpp"
#include "io/paraview.hpp"
#include "io/results.hpp"
#include "io/run_folder.hpp"
#include "io/run_origin.hpp"

namespace greenwater {

/// Due at 0, T, 2T ...: at the first step that has reached the next multiple.
class Schedule {
 public:
  explicit Schedule(double period) : period_(period) {}
  /// True when something is due at `time` [s]; the next multiple is then waited for. A period of 0 is always due.
  bool due(double time);

 private:
  double period_, next_ = 0;
};

class Recorder {
 public:
  /// Makes the folder with case, resolved case and manifest. Throws CaseError or FileError.
  Recorder(const RunOptions& options, const Scene& scene, const CaseFile& file, const RunOrigin& origin,
           const Simulation& simulation);

  const RunFolder& folder() const { return folder_; }

  void history(const RunFacts& facts, double ms_per_step);
  /// Samples the probes that are due, and writes a frame when one is.
  void sample(Simulation& simulation);
  /// The frame of this step, if frames are wanted and this one is not written yet.
  void last_frame(const Simulation& simulation);
  /// Closes the files and rewrites the manifest with the end; the marker comes last.
  void finish(const RunEnd& end, Marker marker);

 private:
  struct Probe {
    Csv file;
    Schedule schedule;
    std::size_t index;
  };
  void open_probes(const Simulation& simulation);
  void open_frames(const Simulation& simulation);
  void open_paraview(const Picture& first);
  void frame(const Simulation& simulation);

  const Scene& scene_;
  RunOrigin origin_;
  std::string case_text_;
  RunFolder folder_;
  Csv history_;
  std::vector<Probe> probes_;
  bool opened_ = false;
  bool frames_wanted_, paraview_wanted_;
  Schedule frame_schedule_;
  std::unique_ptr<Results> results_;
  std::unique_ptr<Paraview> paraview_, moving_walls_;
  std::vector<Paraview> solids_;
  std::int64_t last_frame_step_ = -1;
};

/// The wish for the run folder, from the options or from the case; throws CaseError when it cannot be fulfilled.
FolderWish folder_wish(const RunOptions& options, const Scene& scene, WallTime now);

}  // namespace greenwater
