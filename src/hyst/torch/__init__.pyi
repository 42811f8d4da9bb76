from hyst.torch.function import evaluate as evaluate
