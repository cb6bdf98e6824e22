#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits a model's tables by PyTorch: torch_tables.py SOURCE [--budget BYTES] [--steps N] [-o MODEL].

burnish fits a model of SOURCE first. Then Adam lowers another loss than burnish has: the mean absolute difference of the
fourth roots of model and source, weighted by the cosine. `Values` makes model.eval differentiable by the logarithms of
the tables, which are ordinary parameters. Prints the loss before and after, each of tables rounded to their formats."""
import argparse

import burnish
import numpy as np
import torch


class Values(torch.autograd.Function):
    """f_r at pairs of directions, differentiable by the natural logarithms of the model's tables."""

    @staticmethod
    def forward(ctx, model, wi, wo, *log_tables):
        # Tables of floats stand for the real numbers that an optimizer moves; other formats would round them.
        changed = model.with_log_tables([t.detach().double().cpu().numpy() for t in log_tables], format="float")
        ctx.changed, ctx.wi, ctx.wo, ctx.types = changed, wi, wo, [t.dtype for t in log_tables]
        values = torch.empty((len(wi), model.channels), dtype=torch.float64)
        return changed.eval(wi, wo, out=values)

    @staticmethod
    def backward(ctx, gradient):
        # d f / d log(value) = value * d f / d value; none for the model and the directions.
        by_value = ctx.changed.table_gradient(ctx.wi, ctx.wo, gradient.contiguous())
        by_log = [torch.from_numpy(g * table.values) for g, table in zip(by_value, ctx.changed.tables)]
        return None, None, None, *(g.to(kind) for g, kind in zip(by_log, ctx.types))


def log_tables_of(model):
    """The logarithms of the tables as parameters."""
    return [torch.tensor(np.log(t.values, dtype=np.float64), requires_grad=True) for t in model.tables]


def drawn_pairs(count, generator):
    """wi and wo uniform over the hemisphere, float64 (count, 3) each."""
    directions = torch.randn((2, count, 3), dtype=torch.float64, generator=generator)
    directions /= directions.norm(dim=2, keepdim=True)
    directions[..., 2] = directions[..., 2].abs().clamp(min=1e-6)
    return directions[0], directions[1]


def loss_of(values, expected, wi):
    return ((values.clamp(min=1e-12) ** 0.25 - expected**0.25).abs() * wi[:, 2:]).mean()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("--budget", default=2700, help="bytes of the model (%(default)s)")
    parser.add_argument("--samples", type=int, default=200_000, help="pairs that the fit uses (%(default)s)")
    parser.add_argument("--steps", type=int, default=200, help="of the optimizer (%(default)s)")
    parser.add_argument("--pairs", type=int, default=4096, help="a step (%(default)s)")
    parser.add_argument("-o", "--output", help="a file for the model")
    arguments = parser.parse_args()

    source = burnish.open_source(arguments.source)
    model = burnish.fit(source, budget=arguments.budget, samples=arguments.samples)
    log_tables = log_tables_of(model)
    optimizer = torch.optim.Adam(log_tables, lr=0.01)
    generator = torch.Generator().manual_seed(1)
    held_out = drawn_pairs(20_000, generator)
    expected = torch.from_numpy(source.eval(*held_out)).clamp(min=0)

    def held_out_loss(of):
        return loss_of(torch.from_numpy(of.eval(*held_out)), expected, held_out[0]).item()

    before = held_out_loss(model)
    for step in range(arguments.steps):
        for group in optimizer.param_groups:
            group["lr"] = 0.01 * (1 - step / arguments.steps)
        wi, wo = drawn_pairs(arguments.pairs, generator)
        truth = torch.from_numpy(source.eval(wi, wo)).clamp(min=0)
        optimizer.zero_grad()
        loss_of(Values.apply(model, wi, wo, *log_tables), truth, wi).backward()
        optimizer.step()
    learned = model.with_log_tables([t.detach().numpy() for t in log_tables])
    print(f"loss {before:.6f} before, {held_out_loss(learned):.6f} after {arguments.steps} steps, {learned.bytes} bytes")
    if arguments.output:
        burnish.write_model(arguments.output, learned)


if __name__ == "__main__":
    main()
