// SPDX-License-Identifier: Apache-2.0
// burnish-mpi fit-surface does the same as `burnish fit-surface`, with the ranks that mpirun or srun starts.
#include <exception>

#include <fmt/core.h>
#include <mpi.h>

#include "commands.h"
#include "mpi_crew.h"
#include "usage.h"

namespace {

int run(int argc, char** argv) {
  burnish::cli::MpiCrew crew;
  CLI::App app{"burnish-mpi: surfaces fitted by the ranks of MPI"};
  app.require_subcommand(1);
  burnish::cli::add_fit_surface_command(app, &crew);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return crew.rank() == 0 ? app.exit(error) : 0;
    if (crew.rank() == 0)
      fmt::print(stderr, "burnish-mpi: {}\nRun with --help for more information.\n",
                 burnish::short_message(error.what()));
    return 2;
  } catch (const std::exception& error) {
    // Without the abort, the other ranks would wait for this one.
    fmt::print(stderr, "burnish-mpi: {}\n", burnish::short_message(error.what()));
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int code = run(argc, argv);
  MPI_Finalize();
  return code;
}
