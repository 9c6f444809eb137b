"""The one module that imports torch and transformers: a Qwen3-VL as two plain functions.

The chat template and the expansion of image tokens are done here rather than by the model's
processor class, which would need a video library to be installed that no picture needs.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from c2nav_engine.contract.prompt import Part
from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import MissingExtra
from c2nav_engine.rankers.images import scaled
from c2nav_engine.rankers.token_trie import TokenTrie

_IMAGE_MARK = "<|image_pad|>"


def _optional(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        message = f"the ranker local needs {name}, which is not installed"
        raise MissingExtra(f"{message}. Install the extra: pip install 'c2nav[local]'") from error


@dataclass(frozen=True, slots=True)
class LocalSettings:
    """Which model, where, and how large its pictures.

    Attributes:
        model: Folder or hub id.
        device: "cpu", "cuda", "cuda:1" or "auto" (CUDA when there is one).
        image_px: Longest side after scaling down; 0 for the recorded bytes.
    """

    model: str
    device: str = "auto"
    image_px: int = 0


class LocalModel:
    """A loaded model: label scores and constrained answers for batches of prompts.

    Half precision on CUDA, single on a CPU. Not safe for several threads at once.
    """

    def __init__(self, settings: LocalSettings) -> None:
        self.settings = settings
        self._torch = _optional("torch")
        transformers = _optional("transformers")
        cuda = self._torch.cuda.is_available()
        self.device = ("cuda" if cuda else "cpu") if settings.device == "auto" else settings.device
        dtype = self._torch.float32 if self.device == "cpu" else self._torch.bfloat16
        self._tokenizer = transformers.AutoTokenizer.from_pretrained(settings.model)
        self._images = transformers.Qwen2VLImageProcessorPil.from_pretrained(settings.model)
        self._model = transformers.AutoModelForImageTextToText.from_pretrained(
            settings.model, dtype=dtype
        )
        self._model.to(self.device).eval()
        self._image_px = settings.image_px
        self._image_id = self._tokenizer.convert_tokens_to_ids(_IMAGE_MARK)

    def first_token(self, text: str) -> int:
        """Id of the token that an answer of these words begins with."""
        return int(self._tokenizer.encode(text, add_special_tokens=False)[0])

    def prepare(self, parts: Sequence[Part]) -> Any:
        """One prompt as model inputs, ready for the assistant's first token."""
        pictures = [part for part in parts if isinstance(part, Picture)]
        content = [
            {"type": "text", "text": part} if isinstance(part, str) else {"type": "image"}
            for part in parts
        ]
        text: str = self._tokenizer.apply_chat_template(
            [{"role": "user", "content": content}], tokenize=False, add_generation_prompt=True
        )
        if not pictures:
            return self._tokenizer(text, return_tensors="pt")
        arrays = [_rgb(picture, self._image_px) for picture in pictures]
        seen = self._images(images=arrays, return_tensors="pt")
        # Each placeholder becomes as many tokens as its picture has merged patches.
        merged = [int(grid.prod()) // self._images.merge_size**2 for grid in seen["image_grid_thw"]]
        pieces = text.split(_IMAGE_MARK)
        expanded = pieces[0] + "".join(
            _IMAGE_MARK * count + piece for count, piece in zip(merged, pieces[1:], strict=True)
        )
        inputs = self._tokenizer(expanded, return_tensors="pt", add_special_tokens=False)
        return {**inputs, **seen}

    def length(self, inputs: Any) -> int:
        """Prompt tokens of one prepared prompt."""
        return int(inputs["input_ids"].shape[1])

    def label_scores(
        self, batch: Sequence[Any], labels: Sequence[Sequence[int]]
    ) -> list[list[float]]:
        """Log-probabilities of each prompt's label tokens as the answer's first token.

        Args:
            batch: Prepared prompts of one length.
            labels: Token ids per prompt.
        """
        with self._torch.inference_mode():
            logits = self._model(**self._joined(batch), logits_to_keep=1).logits[:, -1]
            scores = self._torch.log_softmax(logits.float(), dim=-1).cpu()
        return [
            [float(row[label]) for label in wanted]
            for row, wanted in zip(scores, labels, strict=True)
        ]

    def constrained(self, inputs: Any, choices: Sequence[str]) -> str:
        """The greedy answer among the choices."""
        end = int(self._tokenizer.eos_token_id)
        sequences = [self._tokenizer.encode(text, add_special_tokens=False) for text in choices]
        trie, begun = TokenTrie(sequences, end=end), self.length(inputs)

        def allowed(_batch: int, written: Any) -> list[int]:
            return trie.allowed(written[begun:].tolist())

        with self._torch.inference_mode():
            written = self._model.generate(
                **self._joined([inputs]),
                max_new_tokens=trie.longest,
                do_sample=False,
                prefix_allowed_tokens_fn=allowed,
                eos_token_id=end,
                pad_token_id=end,
            )
        return str(self._tokenizer.decode(written[0, begun:], skip_special_tokens=True))

    def _joined(self, batch: Sequence[Any]) -> dict[str, Any]:
        # Prompts of one length need no padding, which would shift the last bits of the scores.
        ids = self._torch.cat([inputs["input_ids"] for inputs in batch]).to(self.device)
        joined: dict[str, Any] = {
            "input_ids": ids,
            "attention_mask": self._torch.ones_like(ids),
        }
        if "pixel_values" in batch[0]:
            for name in ("pixel_values", "image_grid_thw"):
                joined[name] = self._torch.cat([inputs[name] for inputs in batch]).to(self.device)
            joined["pixel_values"] = joined["pixel_values"].to(self._model.dtype)
            joined["mm_token_type_ids"] = (ids == self._image_id).int()
        return joined


def _rgb(picture: Picture, image_px: int) -> np.ndarray:
    jpeg = scaled(picture, image_px) if image_px else picture.jpeg
    bgr = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    return np.ascontiguousarray(np.asarray(bgr)[..., ::-1])
